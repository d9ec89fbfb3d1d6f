#pragma once

#include <algorithm>
#include <cmath>

#include "instruments/errors/statistics.h"

namespace frond {

/// A mean that cannot be known.
inline constexpr MeanError kUnknown{NAN, NAN};

/// Sums of weights, and of a quantity times its weight, whose ratio is the quantity's mean.
struct RatioSums {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(double value, double weight) {
    const double v = value * weight;
    x += v, y += weight, xx += v * v, xy += v * weight, yy += weight * weight;
  }
  RatioSums& operator+=(const RatioSums& o) {
    x += o.x, y += o.y, xx += o.xx, xy += o.xy, yy += o.yy;
    return *this;
  }
  /// Returns the ratio, with the error of its linearization.
  MeanError ratio() const {
    if (!(y > 0)) return kUnknown;
    const double mean = x / y, squares = std::max(0.0, xx - 2 * mean * xy + mean * mean * yy);
    return {mean, std::sqrt(squares) / y};
  }
  /// Returns the mean of the weights over n samples.
  MeanError mean_weight(double n) const {
    const double mean = y / n, variance = std::max(0.0, yy / n - mean * mean);
    constexpr double kRounding = 1e-12;  // equal weights have no error
    return {mean, variance > kRounding * mean * mean && n > 1 ? std::sqrt(variance / (n - 1)) : 0};
  }
};

}  // namespace frond
