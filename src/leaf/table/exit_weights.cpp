#include "leaf/table/exit_weights.h"

#include <cmath>
#include <numbers>

#include "leaf/solve/quadrature.h"
#include "leaf/table/series_lookup.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {

std::vector<double> exit_weights(double index, size_t cells, Measure measure) {
  static const std::vector<QuadratureNode> rule = gauss_legendre(16);
  std::vector<double> weights(cells + 3, 0.0);
  for (const auto& [x, weight] : rule) {
    const double mu = x * x;  // dense at grazing, where transmittance is like a square root
    const Crossing out = fresnel(mu, 1 / index);
    const double over = measure == Measure::plain ? 1 : out.cos_t;
    const double whole = weight * 2 * x * mu * 2 * std::numbers::pi * (1 - out.reflectance) / over;
    const SineNodes nodes(static_cast<float>(std::sqrt(1 - mu * mu)), static_cast<int>(cells));
    for (size_t k = 0; k < 4; ++k) weights[nodes.first + k] += whole * static_cast<double>(nodes.weight[k]);
  }
  return weights;
}

}  // namespace frond::leaf
