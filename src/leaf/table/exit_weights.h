#pragma once

#include <cstddef>
#include <vector>

namespace frond::leaf {

/// What stands between a series (LeafModes) and f, beside the shares that pass the surface.
enum class Measure {
  over_inner_cosine,  ///< f = (1 - F_i) (1 - F_o) / mu_o' * series
  plain,              ///< f = (1 - F_i) (1 - F_o) * series
};

/// Of each node of the leaving sine, on a grid of so many cells in [0, 1] and one beyond on either side, in the
/// integral of f |cos theta_o| / (1 - F_i) over the hemisphere, for mode 0.
std::vector<double> exit_weights(double index, size_t cells, Measure measure);

}  // namespace frond::leaf
