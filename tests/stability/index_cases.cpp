#include "leaf/tissue/specimens.h"
#include "tests/stability/cases.h"
#include "tests/stability/leaf_methods.h"

namespace frond::stability {
namespace {

using leaf::Tissue;
using leaf::TissueModel;

struct Indices {
  std::string name;
  double cuticle, mesophyll, air_space = 1, wall = 1.3;
};

const std::vector<double> kIndexAngles{5, 40, 60, 88, 130};

void add_indices(Theme& theme, const leaf::Specimen& specimen, const Indices& indices, double depth, double bound) {
  const auto& [name, n_c, n_m, n_air, n_a] = indices;
  const TissueModel model(specimen.params);
  Tissue tissue = model.at(800);
  const bool bifacial = specimen.params.structure == leaf::Structure::bifacial;
  tissue.n = {1, n_c, n_m, n_air, bifacial ? n_a : n_m, n_c, 1};
  for (double& d : tissue.optical_depth) d = d > 0 ? depth : 0;
  Row& row = theme.add(fmt::format("{}, {}, depth {:g}", specimen.name, name, depth),
                       fmt::format("exact; solver within {}", rounded_up(bound)));
  compare_tissue_methods(row, tissue, solved_finely(tissue, kIndexAngles), bound);
}

/// Equal indices without absorption: R = 0, T = 1.
void add_equal(Theme& theme, const leaf::Specimen& specimen) {
  const TissueModel model(specimen.params);
  Tissue tissue = model.at(800);
  tissue.n.fill(1);
  tissue.optical_depth = {};
  Row& row = theme.add(fmt::format("{}, all indices 1, no absorption", specimen.name), "R = 0, T = 1");
  compare_tissue_methods(row, tissue, {kIndexAngles, std::vector<leaf::Shares>(kIndexAngles.size(), {0, 0, 1})}, 1e-12);
}

}  // namespace

Theme indices() {
  Theme theme{
      "Refractive indices outside those of leaves",
      "An artificial tissue at 5, 40, 60, 88 and 130 degrees, against the solver with twice its nodes. n_c is the "
      "refractive index of the cuticle, n_m of the mesophyll, n_a of the antidermal wall; depth is the optical depth "
      "of the mesophyll."};
  const Indices all[] = {
      {"n_c 0.8: below that of air", 0.8, 1.4},
      {"all indices of the leaf below 1", 0.8, 0.7, 0.9, 0.7},
      {"n_m 1.0001: critical angle 89.2 degrees", 1.4, 1.0001},
      {"n_m 1 + 1e-9: just above that of the air space", 1.4, 1 + 1e-9},
      {"n_m = n_c", 1.4, 1.4},
      {"n_c and n_m 3", 3, 3},
      {"n_c 1.4, n_m 3", 1.4, 3},
      {"n_a 3: light that enters the wall would be trapped in it", 1.4, 1.4, 1, 3},
  };
  for (const leaf::Specimen& specimen : std::span(leaf::kSpecimens).first(2)) {
    add_equal(theme, specimen);
    for (const Indices& indices : all) {
      if (indices.wall == 3 && specimen.params.structure == leaf::Structure::unifacial) continue;
      for (const double depth : {0.0, 0.5}) add_indices(theme, specimen, indices, depth, 1e-4);
    }
  }
  return theme;
}

}  // namespace frond::stability
