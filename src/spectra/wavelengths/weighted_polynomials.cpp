#include "spectra/wavelengths/weighted_polynomials.h"

#include <cmath>

namespace frond {
namespace {

/// Variable of the polynomials: scaled so that its powers stay near 1.
double reduced(double nm) { return (nm - 560) / 100; }

}  // namespace

double integrate_visible(const std::function<double(double)>& f) {
  const double offset = 0.5 / std::sqrt(3.0);
  double sum = 0;
  for (int nm = int(kCieRange_nm.min); nm < int(kCieRange_nm.max); ++nm)
    sum += (f(nm + 0.5 - offset) + f(nm + 0.5 + offset)) / 2;
  return sum;
}

WeightedPolynomials::WeightedPolynomials(std::function<double(double)> weight, size_t degree)
    : weight_(std::move(weight)) {
  double before = 1;
  for (size_t n = 0; n < degree; ++n) {
    const auto square = [&](double nm) { return weight_(nm) * at(n, nm) * at(n, nm); };
    const double norm = integrate_visible(square);
    const double first = integrate_visible([&](double nm) { return square(nm) * reduced(nm); });
    a_.push_back(first / norm);
    b_.push_back(n == 0 ? 0 : norm / before);
    before = norm;
  }
}

double WeightedPolynomials::at(size_t n, double nm) const {
  double before = 0, value = 1;
  for (size_t i = 0; i < n; ++i) {
    const double next = (reduced(nm) - a_[i]) * value - b_[i] * before;
    before = value;
    value = next;
  }
  return value;
}

double WeightedPolynomials::root(size_t n, double nm) const {
  constexpr double kStep_nm = 1e-3;
  for (int i = 0; i < 30; ++i) {
    // Central difference: the polynomial's derivative is not part of the recurrence.
    const double slope = (at(n, nm + kStep_nm) - at(n, nm - kStep_nm)) / (2 * kStep_nm);
    nm -= at(n, nm) / slope;
  }
  return nm;
}

std::vector<double> WeightedPolynomials::rule(const std::vector<double>& points_nm) const {
  std::vector<double> weights;
  for (const double point : points_nm)
    weights.push_back(integrate_visible([&](double nm) {
      double lagrange = 1;
      for (const double other : points_nm)
        if (other != point) lagrange *= (nm - other) / (point - other);
      return weight_(nm) * lagrange;
    }));
  return weights;
}

}  // namespace frond
