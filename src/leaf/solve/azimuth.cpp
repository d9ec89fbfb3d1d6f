#include "leaf/solve/azimuth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frond::leaf {

namespace {

/// Quadrature for lobes whose exponent is not an integer.
struct Place {
  double share;  ///< phi over phi_max
  double weight;
  double cosine;  ///< of phi where the lobe is not cut, and phi_max is pi
};

const std::vector<Place>& places() {
  static const std::vector<Place> all = [] {
    std::vector<Place> result;
    for (const auto& [x, weight] : gauss_legendre(24))
      result.push_back({1 - x * x, weight * 2 * x, std::cos(std::numbers::pi * (1 - x * x))});
    return result;
  }();
  return all;
}

}  // namespace

AzimuthModes::AzimuthModes(double exponent) : exponent_(exponent), fraction_(exponent - std::floor(exponent)) {}

AzimuthModes::Angles::Angles(double mu_axis, double mu)
    : a(mu_axis * mu),
      b(std::sqrt(std::max(0.0, (1 - mu_axis * mu_axis) * (1 - mu * mu)))),
      phi_max(a >= b ? std::numbers::pi : std::acos(-a / b)) {}

/// (1 / pi) times the integrals of (a + b cos phi)^power and ^(power + 1) up to phi_max, by quadrature that is dense at
/// phi_max, where the base may reach 0.
AzimuthModes::Means AzimuthModes::direct(double power, const Angles& angles) const {
  const auto [a, b, phi_max] = angles;
  const bool is_cut = a < b;
  Means sums{0, 0};
  for (const Place& p : places()) {
    const double cosine = is_cut ? std::cos(phi_max * p.share) : p.cosine;
    const double base = std::max(0.0, a + b * cosine);
    const double value = p.weight * std::pow(base, power);
    sums.value += value;
    sums.next += value * base;
  }
  const double scale = phi_max / std::numbers::pi;
  return {sums.value * scale, sums.next * scale};
}

AzimuthModes::Means AzimuthModes::means(const Angles& angles) const {
  // Integrating d((a + b cos phi)^(n-1) sin phi) / d phi by parts gives for the means M_n
  //   n M_n = (2n - 1) a M_(n-1) - (n - 1) (a^2 - b^2) M_(n-2),  n > 1,
  // because the edge term vanishes where the base does and at phi = pi. Forward it is stable: a >= 0.
  const auto [a, b, phi_max] = angles;
  Means m;
  if (fraction_ > 0)
    m = direct(fraction_, angles);
  else
    m = {phi_max / std::numbers::pi, a * phi_max / std::numbers::pi + b * std::sin(phi_max) / std::numbers::pi};
  const auto steps = static_cast<int>(exponent_);
  for (int i = 0; i < steps; ++i) {
    const double n = fraction_ + 2 + i;
    m = {m.next, ((2 * n - 1) * a * m.next - (n - 1) * (a * a - b * b) * m.value) / n};
  }
  return {std::max(0.0, m.value), std::max(0.0, m.next)};
}

double AzimuthModes::mean(double mu_axis, double mu) const { return means(Angles(mu_axis, mu)).value; }

// y = max(0, a + b cos phi)^e solves (a + b cos phi) y' = -e b sin(phi) y, cut or not. Its modes c_m therefore obey
//   b (e + 1 + m) c_(m+1) = b (e + 1 - m) c_(m-1) - 2 a m c_m,  m >= 1.
// The other solution grows like (a/b + sqrt((a/b)^2 - 1))^m: where the lobe is cut, or nearly, the recurrence may run
// forward; elsewhere it must run backward, as ratios of neighbours (Gautschi 1967).
void AzimuthModes::operator()(double mu_axis, double mu, std::span<double> modes) const {
  const Angles angles(mu_axis, mu);
  const Means m = means(angles);
  modes[0] = m.value;
  std::ranges::fill(modes.subspan(1), 0.0);
  if (angles.b == 0 || modes.size() == 1) return;
  constexpr double kNearlyCut = 1.05;
  if (angles.a < kNearlyCut * angles.b)
    forward(angles, m, modes);
  else
    backward(angles, m, modes);
}

void AzimuthModes::forward(const Angles& angles, const Means& means, std::span<double> modes) const {
  const double a = angles.a, b = angles.b;
  modes[1] = (means.next - a * means.value) / b;
  for (size_t i = 1; i + 1 < modes.size(); ++i) {
    const auto m = static_cast<double>(i);
    modes[i + 1] = ((exponent_ + 1 - m) * modes[i - 1] - 2 * a / b * m * modes[i]) / (exponent_ + 1 + m);
  }
}

void AzimuthModes::backward(const Angles& angles, const Means& means, std::span<double> modes) const {
  constexpr size_t kBeyond = 60;  // by there an error has shrunk below rounding; whole exponents end the series anyway
  const double a = angles.a, b = angles.b;
  double ratio = 0;
  for (size_t i = modes.size() + kBeyond; i >= 1; --i) {
    const auto m = static_cast<double>(i);
    ratio = b * (exponent_ + 1 - m) / (b * (exponent_ + 1 + m) * ratio + 2 * a * m);
    if (i < modes.size()) modes[i] = ratio;
  }
  for (size_t i = 1; i < modes.size(); ++i) modes[i] = i == 1 ? means.value * modes[1] : modes[i - 1] * modes[i];
}

}  // namespace frond::leaf
