#include "leaf/azimuth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frond::leaf {

AzimuthMean::AzimuthMean(double exponent) : exponent_(exponent), fraction_(exponent - std::floor(exponent)) {
  if (fraction_ > 0) quadrature_ = gauss_legendre(24);
}

/// (1 / pi) times the integral of (a + b cos phi)^power up to phi_max, by quadrature that is dense at phi_max, where
/// the base may reach 0.
double AzimuthMean::direct(double power, double a, double b, double phi_max) const {
  double sum = 0;
  for (const auto& [x, weight] : quadrature_) {
    const double phi = phi_max * (1 - x * x);
    sum += weight * 2 * x * std::pow(std::max(0.0, a + b * std::cos(phi)), power);
  }
  return sum * phi_max / std::numbers::pi;
}

double AzimuthMean::operator()(double mu_axis, double mu) const {
  // cos alpha = a + b cos phi. Integrating d((a + b cos phi)^(n-1) sin phi) / d phi by parts gives for the means M_n
  //   n M_n = (2n - 1) a M_(n-1) - (n - 1) (a^2 - b^2) M_(n-2),  n > 1,
  // because the edge term vanishes where the base does and at phi = pi. Forward it is stable: a >= 0.
  const double a = mu_axis * mu;
  const double b = std::sqrt(std::max(0.0, (1 - mu_axis * mu_axis) * (1 - mu * mu)));
  const double phi_max = a >= b ? std::numbers::pi : std::acos(-a / b);
  double before, value;
  if (fraction_ > 0) {
    before = direct(fraction_, a, b, phi_max);
    value = direct(fraction_ + 1, a, b, phi_max);
  } else {
    before = phi_max / std::numbers::pi;
    value = a * before + b * std::sin(phi_max) / std::numbers::pi;
  }
  if (exponent_ == fraction_) return before;
  for (double n = fraction_ + 2; n <= exponent_; ++n) {
    const double next = ((2 * n - 1) * a * value - (n - 1) * (a * a - b * b) * before) / n;
    before = value;
    value = next;
  }
  return std::max(0.0, value);
}

}  // namespace frond::leaf
