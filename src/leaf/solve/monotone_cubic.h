#pragma once

#include <cstddef>
#include <vector>

namespace frond::leaf {

/// Cubic through given points, without overshoot: where the points rise it rises, between two equal ones it is level
/// (Fritsch and Carlson 1980; slopes of the parabola through three neighbours, bounded). Fourth order where the points
/// are smooth and the bounds do not bite. Beyond the ends the last value holds.
class MonotoneCubic {
 public:
  /// x ascends; one point at least.
  MonotoneCubic(std::vector<double> x, std::vector<double> y);

  double operator()(double x) const;

 private:
  double parabola_slope(size_t middle, size_t at) const;
  double bounded_slope(size_t i) const;
  double secant(size_t i) const { return (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]); }

  std::vector<double> x_, y_, slope_;
};

}  // namespace frond::leaf
