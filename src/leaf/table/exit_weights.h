#pragma once

#include <cstddef>
#include <vector>

namespace frond::leaf {

/// The factor between a series (LeafModes) and f, apart from the Fresnel transmittances of the surface.
enum class Measure {
  over_inner_cosine,  ///< f = (1 - F_i) (1 - F_o) / mu_o' * series
  plain,              ///< f = (1 - F_i) (1 - F_o) * series
};

/// Returns the weight of each node of the leaving sine in the integral of f |cos theta_o| / (1 - F_i) over the
/// hemisphere, for mode 0. Nodes: a grid of `cells` cells in [0, 1] and one beyond on either side; `index`: of the
/// cuticle.
std::vector<double> exit_weights(double index, size_t cells, Measure measure);

}  // namespace frond::leaf
