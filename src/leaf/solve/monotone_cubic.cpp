#include "leaf/solve/monotone_cubic.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace frond::leaf {

MonotoneCubic::MonotoneCubic(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)), slope_(x_.size(), 0.0) {
  assert(!x_.empty() && x_.size() == y_.size());
  if (x_.size() > 1)
    for (size_t i = 0; i < x_.size(); ++i) slope_[i] = bounded_slope(i);
}

/// Slope at point `at` of the parabola through point `middle` and its neighbours.
double MonotoneCubic::parabola_slope(size_t middle, size_t at) const {
  const double left = secant(middle - 1), right = secant(middle);
  const double bend = (right - left) / (x_[middle + 1] - x_[middle - 1]);
  return left + bend * (2 * x_[at] - x_[middle - 1] - x_[middle]);
}

/// Fritsch and Carlson's bound: at most three times the flatter neighbour's slope, and 0 at extrema.
double MonotoneCubic::bounded_slope(size_t i) const {
  const size_t last = x_.size() - 1;
  if (last == 1) return secant(0);
  const double left = secant(i > 0 ? i - 1 : 0), right = secant(std::min(i, last - 1));
  const double slope = parabola_slope(std::clamp<size_t>(i, 1, last - 1), i);
  if (left * right <= 0 || slope * left <= 0) return 0;
  return std::copysign(std::min({std::abs(slope), 3 * std::abs(left), 3 * std::abs(right)}), left);
}

double MonotoneCubic::operator()(double x) const {
  if (x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const auto i = static_cast<size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin()) - 1;
  const double width = x_[i + 1] - x_[i], t = (x - x_[i]) / width, rise = y_[i + 1] - y_[i];
  const double a = slope_[i] * width, b = slope_[i + 1] * width;
  return y_[i] + t * (a + t * (3 * rise - 2 * a - b + t * (a + b - 2 * rise)));
}

}  // namespace frond::leaf
