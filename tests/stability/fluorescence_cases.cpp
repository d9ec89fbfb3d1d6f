#include <cmath>

#include "core/fluorescence.h"
#include "instruments/fluorescence_matrix.h"
#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"
#include "tests/support/input_error.h"

namespace frond::stability {
namespace {

using test::number;
using test::words;

constexpr int64_t kRays = 400;

/// A leaf with fluorescence, whose table is solved once.
class FluorescentLeaf {
 public:
  FluorescentLeaf(std::string_view material, const Parameters& params)
      : specimen_(material, params, 551),
        fluorescence_(dynamic_cast<const FluorescentMaterial&>(specimen_.material())
                          .fluorescence({OneWavelength(551), pool_, silent_log(), {}})) {}

  /// Every 5 nm of emission.
  FluorescenceMatrix measured(double theta_deg, double excitation_nm) const {
    FluorescenceRequest request{theta_deg, {excitation_nm}, {}, kRays, 11};
    for (double nm = kEmission_nm.min; nm <= kEmission_nm.max; nm += 5) request.emission_nm.push_back(nm);
    return measure_fluorescence(*fluorescence_, request, pool_);
  }

 private:
  ThreadPool pool_{1};
  Specimen specimen_;
  std::shared_ptr<const Fluorescence> fluorescence_;
};

/// Photons that leave both sides, and the balance: what is emitted leaves or is reabsorbed, at most what is absorbed.
Cell cell_of(const FluorescenceMatrix& m, const FluorescenceMatrix& truth) {
  using FCell = FluorescenceMatrix::Cell;
  constexpr double kBalance = 1e-4;
  Comparison comparison(m.rays > 0 ? 0 : kBalance);
  const int64_t rays = kRays * static_cast<int64_t>(m.emission_nm.size());
  const auto integral = [&m](Estimate FCell::*member) { return m.integral(0, member); };
  for (const auto& [name, member] : {std::pair{"Mb", &FCell::lit_side}, {"Mf", &FCell::opposite_side}})
    if (m.rays > 0)
      comparison.add(name, integral(member), truth.integral(0, member).mean, rays);
    else
      comparison.add(name, integral(member).mean, truth.integral(0, member).mean);
  const double emitted = integral(&FCell::emitted).mean, absorbed = m.cells[0].absorbed.mean;
  if (std::isnan(emitted)) return comparison.cell();
  const double rest =
      integral(&FCell::reabsorbed).mean + integral(&FCell::lit_side).mean + integral(&FCell::opposite_side).mean;
  comparison.require(std::abs(rest - emitted) <= kBalance * emitted, "photons are lost");
  comparison.require(emitted <= absorbed * (1 + 1e-3) || m.rays > 0, "more is emitted than absorbed");
  return comparison.cell();
}

void add_leaf(Theme& theme, const std::string& name, const std::string& expected, const Parameters& params,
              double excitation_nm) {
  Row& row = theme.add(name, expected);
  const FluorescentLeaf solved("leaf_solved", params), walked("abm", params);
  for (const double theta_deg : {8.0, 89.0, 89.99, 130.0}) {
    const FluorescenceMatrix truth = solved.measured(theta_deg, excitation_nm);
    for (const auto& [method, leaf] : {std::pair{Method::abm, &walked}, {Method::solved_leaf, &solved}}) {
      const Cell cell = cell_of(leaf->measured(theta_deg, excitation_nm), truth);
      if (!row.cells.contains(method) || cell.is_surprise) row.add(method, cell);
    }
  }
}

}  // namespace

Theme fluorescence() {
  Theme theme{
      "Fluorescence",
      "Photons that leave both sides of a leaf, over all emission, for light at 8, 89, 89.99 and 130 degrees: the "
      "walk against the solution, and the solution's balance of photons within 1e-4. The cell is that of 8 degrees "
      "unless another is unexpected."};
  const ParsedParam one = number("float", "fluorescence", {1});
  for (const std::string specimen : {"soybean", "maize"}) {
    const ParsedParam of = words("specimen", {specimen});
    const auto with = [&of](Parameters more) {
      more.push_back(of);
      return more;
    };
    add_leaf(theme, specimen + ", yield 1", "the solution's; the balance closes", with({one}), 440);
    add_leaf(theme, specimen + ", yield 0", "nothing is emitted", with({}), 440);
    add_leaf(theme, specimen + ", no chlorophyll", "nothing is emitted",
             with({one, number("float", "chlorophylla", {0}), number("float", "chlorophyllb", {0})}), 440);
    add_leaf(theme, specimen + ", chlorophyll alone", "the solution's; the balance closes",
             with({one, number("float", "chlorophylla", {100}), number("float", "carotenoids", {0}),
                   number("float", "protein", {0}), number("float", "cellulose", {0}), number("float", "lignin", {0})}),
             440);
    add_leaf(theme, specimen + ", no mesophyll", "nothing is emitted",
             with({one, number("float", "mesophyllfraction", {0})}), 440);
    add_leaf(theme, specimen + ", excitation at 720 nm, within the emission", "the solution's; the balance closes",
             with({one}), 720);
  }
  const TestFolder folder("stability");
  const ParsedParam file =
      words("fluorescencematrices", {folder.write("m.csv",
                                                  "excitation_nm,emission_nm,Mb,Mf\n"
                                                  "400,640,0,0\n400,850,1e-3,0\n750,640,0,1e-3\n750,850,1e-3,1e-3\n")});
  Row& row = theme.add("matrices of a file, grazing light, excitation at 400 and 750 nm", "the file's");
  for (const double excitation_nm : {400.0, 750.0}) {
    const FluorescenceMatrix truth = FluorescentLeaf("leaf_solved", {file}).measured(8, excitation_nm);
    for (const auto& [method, material] : kLeafMaterials)
      for (const double theta_deg : {89.99, 90.01}) {
        const Cell cell = cell_of(FluorescentLeaf(material, {file}).measured(theta_deg, excitation_nm), truth);
        if (!row.cells.contains(method) || cell.is_surprise) row.add(method, cell);
      }
  }
  return theme;
}

}  // namespace frond::stability
