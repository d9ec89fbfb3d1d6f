#include "leaf/tissue/lobe.h"

#include <boost/math/special_functions/beta.hpp>

namespace frond::leaf {
namespace {

/// -d kept / dx up to a constant. The wall's plane cuts the lobe along a great half circle; tilting the axis by d theta
/// moves that edge, where the lobe is cos^e = (sin theta cos phi)^e: so d kept / d theta goes like sin^e theta, and
/// kept falls from 1 at theta = 0 to 1/2 at 90 degrees. Here x^2 = 1 - cos theta.
double kept_share_slope(double x, double exponent) {
  return std::pow(x, exponent) * std::pow(2 - x * x, (exponent - 1) / 2);
}

/// Gauss-Legendre, five points.
double integrate_slope(double from, double to, double exponent) {
  constexpr std::array<double, 3> kPlace{0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> kWeight{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double sum = kWeight[0] * kept_share_slope(middle, exponent);
  for (size_t i = 1; i < kPlace.size(); ++i)
    sum += kWeight[i] * (kept_share_slope(middle - half * kPlace[i], exponent) +
                         kept_share_slope(middle + half * kPlace[i], exponent));
  return sum * half;
}

/// Returns -1 if pow is cheaper than multiplications.
int small_integer_exponent(double exponent) {
  const bool small = exponent == std::floor(exponent) && exponent <= 64;
  return small ? static_cast<int>(exponent) : -1;
}

/// Beyond 7 numbers pow is cheaper.
int maxima(double exponent) {
  const int whole = small_integer_exponent(exponent);
  return whole % 2 == 1 && whole <= 13 ? (whole + 1) / 2 : 0;
}

}  // namespace

Lobe::Lobe(double exponent)
    : exponent_(exponent),
      peak_((exponent + 1) / (2 * std::numbers::pi)),
      whole_(small_integer_exponent(exponent)),
      maxima_(maxima(exponent)) {}

double Lobe::integrate_kept_share(double cos_axis) const {
  // The integral of `kept_share_slope` in theta, divided by that up to 90 degrees: a regularised incomplete beta
  // function of sin^2 theta. Its complement, at cos^2 theta, keeps precision at grazing.
  constexpr boost::math::policies::policy<boost::math::policies::promote_double<false>> kInDouble;
  const double c2 = std::min(1.0, cos_axis * cos_axis);
  return 0.5 + 0.5 * boost::math::ibeta(0.5, (exponent_ + 1) / 2, c2, kInDouble);
}

Lobe::KeptTable::KeptTable(double exponent) {
  constexpr double kStep = 1.0 / kCells;
  double sum = 0;
  for (size_t i = 0; i <= kCells; ++i) {
    const double x = static_cast<double>(i) * kStep;
    if (i > 0) sum += integrate_slope(x - kStep, x, exponent);
    nodes_[i] = {sum, kept_share_slope(x, exponent) * kStep};
  }
  const double scale = -0.5 / sum;
  for (Node& node : nodes_) node = {1 + scale * node.value, scale * node.slope};
}

}  // namespace frond::leaf
