#pragma once

namespace frond {

/// Closed interval [min, max].
struct Interval {
  double min, max;
  constexpr bool contains(double x) const { return x >= min && x <= max; }  // false for NaN
};

}  // namespace frond
