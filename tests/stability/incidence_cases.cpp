#include "leaf/tissue/specimens.h"
#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"

namespace frond::stability {
namespace {

using leaf::find_specimen;
using leaf::TissueModel;

constexpr double kIncidenceNm = 551, kSolver = 1e-5, kTable = 3e-4;

void add_angles(Theme& theme, std::string name, std::string_view specimen, const std::vector<double>& theta_deg) {
  const leaf::TissueParams& params = find_specimen(specimen)->params;
  const TissueModel model(params);
  const leaf::Tissue tissue = model.at(kIncidenceNm);
  const Lit lit = solved_finely(tissue, theta_deg);
  Row& row = theme.add(fmt::format("{}, {}", specimen, name), fmt::format("exact; solver within {}, table within {}",
                                                                          rounded_up(kSolver), rounded_up(kTable)));
  compare_tissue_methods(row, tissue, lit, kSolver);
  compare_material_methods(row, {params, kIncidenceNm}, lit, kTable);
  compare_solved_leaf(row, solved_specimen({params, kIncidenceNm}), lit);
}

/// Just above and just below the horizon everything is reflected at the surface.
void add_crossing(Theme& theme, std::string_view specimen) {
  const leaf::TissueParams& params = find_specimen(specimen)->params;
  const TissueModel model(params);
  const leaf::Tissue tissue = model.at(kIncidenceNm);
  const std::vector<double> crossing{90 - 1e-9, 90, 90 + 1e-9};
  const Lit lit{crossing, std::vector<leaf::Shares>(crossing.size(), {1, 0, 0})};
  Row& row = theme.add(fmt::format("{}, 90 - 1e-9, 90 and 90 + 1e-9", specimen),
                       "continuous: everything is reflected at the surface; solver within 1e-9, table within 5e-6");
  compare_tissue_methods(row, tissue, lit, 1e-9);
  compare_material_methods(row, {params, kIncidenceNm}, lit, 5e-6);
  compare_solved_leaf(row, solved_specimen({params, kIncidenceNm}), lit);
}

}  // namespace

Theme incidence() {
  Theme theme{
      "Angles of incidence",
      "Rs, Rd and T at 551 nm against the solver with twice its nodes, and across the horizon against 1, 0 and 0. "
      "Angles are in degrees from the adaxial normal: above 90 the abaxial side is lit."};
  for (const char* specimen : {"soybean", "maize"}) {
    for (const double theta_deg : {0.0, 89.9, 89.999, 90.0, 90.1, 180.0})
      add_angles(theme, fmt::format("{}", theta_deg), specimen, {theta_deg});
    add_crossing(theme, specimen);
  }
  return theme;
}

}  // namespace frond::stability
