#include "scene/geometry/leaf_angles.h"

#include <cmath>

#include "core/error.h"
#include "core/math/vec.h"

namespace frond {
namespace {

constexpr double kStep = kPiD / 2 / LeafAngles::kSteps;

}  // namespace

std::span<const LeafAngles> leaf_angle_distributions() {
  static const LeafAngles kDistributions[] = {
      {"spherical", [](double theta) { return std::sin(theta); }},
      {"planophile", [](double theta) { return 1 + std::cos(2 * theta); }},
      {"erectophile", [](double theta) { return 1 - std::cos(2 * theta); }},
      {"plagiophile", [](double theta) { return 1 - std::cos(4 * theta); }},
      {"extremophile", [](double theta) { return 1 + std::cos(4 * theta); }},
      {"uniform", [](double) { return 1.0; }},
      {"horizontal", nullptr},
  };
  return kDistributions;
}

/// The midpoint rule, where the density is smooth. The step is left out, since shares are not normalized.
double LeafAngles::share(int i) const {
  return integral ? integral(i * kStep, (i + 1) * kStep) : density((i + 0.5) * kStep);
}

double LeafAngles::mean() const {
  if (!density) return 0;
  double sum = 0, weighted = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = share(i);
    sum += s, weighted += s * (i + 0.5) * kStep;
  }
  return weighted / sum;
}

LeafAngles ellipsoidal_angles(double chi) {
  const auto density = [chi](double theta) {
    const double c = std::cos(theta), s = std::sin(theta), below = c * c + chi * chi * s * s;
    return s / (below * below);
  };
  return {.name = "ellipsoidal", .density = density, .chi = chi};
}

/// Bisection of log chi: the mean falls from 90 to 0 degrees as chi grows.
double chi_of_mean(double mean) {
  constexpr int kHalvings = 50;
  const double most = ellipsoidal_angles(kLeastChi).mean(), least = ellipsoidal_angles(kMostChi).mean();
  if (!(mean >= least && mean <= most))
    fail({}, "the mean angle of an ellipsoidal distribution lies between {:.3g} and {:.3g} degrees; {:.6g} was given",
         least / kDegree, most / kDegree, mean / kDegree);
  double low = std::log(kLeastChi), high = std::log(kMostChi);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (ellipsoidal_angles(std::exp(middle)).mean() > mean ? low : high) = middle;
  }
  return std::exp((low + high) / 2);
}

/// The density may be infinite at an end of the range: there the power of the distance from this end is integrated in
/// closed form, and the other factor is smooth.
LeafAngles beta_angles(double mu, double nu) {
  const auto density = [mu, nu](double theta) {
    const double t = 2 * theta / kPiD;
    return std::pow(1 - t, mu - 1) * std::pow(t, nu - 1);
  };
  const auto integral = [mu, nu](double from, double to) {
    const double a = 2 * from / kPiD, b = 2 * to / kPiD, middle = (a + b) / 2;
    const auto powers = [](double low, double high, double x) { return (std::pow(high, x) - std::pow(low, x)) / x; };
    if (middle < 0.5) return powers(a, b, nu) * std::pow(1 - middle, mu - 1);
    return powers(std::max(0.0, 1 - b), 1 - a, mu) * std::pow(middle, nu - 1);
  };
  return {"beta", density, integral};
}

LeafAngles tabulated_angles(std::string name, const DensityTable& table) {
  const auto integral = [table](double from, double to) { return table.integral_to(to) - table.integral_to(from); };
  const auto density = [integral](double theta) { return integral(theta - kStep / 2, theta + kStep / 2) / kStep; };
  return {std::move(name), density, integral};
}

}  // namespace frond
