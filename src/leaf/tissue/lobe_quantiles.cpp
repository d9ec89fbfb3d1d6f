#include "leaf/tissue/lobe_quantiles.h"

#include <boost/math/special_functions/beta.hpp>
#include <cmath>

namespace frond::leaf {
namespace {

constexpr boost::math::policies::policy<boost::math::policies::promote_double<false>> kInDouble;

/// x as a function of the share beyond, and its derivative. (1 - s) / 2 has the beta distribution of parameters a and
/// a.
struct QuantileNode {
  double x, slope;
  QuantileNode(double a, double beyond) {
    const double b = boost::math::ibeta_inv(a, a, beyond / 2, kInDouble);
    x = std::sqrt(2 * b);
    slope = 0.5 / (boost::math::ibeta_derivative(a, a, b, kInDouble) * x);
  }
};

}  // namespace

PowerQuantile::PowerQuantile(double a) {
  const uint32_t last = std::bit_cast<uint32_t>(1.f) >> kBitsInside;
  const auto place = [](uint32_t cell) { return static_cast<double>(std::bit_cast<float>(cell << kBitsInside)); };
  QuantileNode from(a, place(kFirstCell));
  for (uint32_t cell = kFirstCell; cell < last; ++cell) {
    const double width = place(cell + 1) - place(cell);
    const QuantileNode to(a, place(cell + 1));
    const double rise = to.x - from.x, begin = width * from.slope, end = width * to.slope;
    cells_.push_back(Float4{static_cast<float>(from.x), static_cast<float>(begin),
                            static_cast<float>(3 * rise - 2 * begin - end),
                            static_cast<float>(begin + end - 2 * rise)});
    from = to;
  }
  cells_.push_back(Float4{1, 0, 0, 0});
}

}  // namespace frond::leaf
