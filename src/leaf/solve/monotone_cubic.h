#pragma once

#include <cstddef>
#include <vector>

namespace frond::leaf {

/// Monotone cubic interpolation without overshoot: it rises where the points rise and is constant between two equal
/// ones (Fritsch and Carlson 1980; slopes of the parabola through three neighbours, bounded). Fourth order where the
/// points are smooth and the bounds are inactive. Constant beyond the ends.
class MonotoneCubic {
 public:
  /// x ascends; at least one point.
  MonotoneCubic(std::vector<double> x, std::vector<double> y);

  double operator()(double x) const;

 private:
  double parabola_slope(size_t middle, size_t at) const;
  double bounded_slope(size_t i) const;
  double secant(size_t i) const { return (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]); }

  std::vector<double> x_, y_, slope_;
};

}  // namespace frond::leaf
