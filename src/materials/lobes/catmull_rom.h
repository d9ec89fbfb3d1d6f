#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace frond {

/// Segment of a cubic spline that interpolates values at nodes, for t in [0, 1] between two nodes.
struct CubicSegment {
  float f0, f1;  ///< values at the ends
  float d0, d1;  ///< derivatives with respect to t

  float at(float t) const { return f0 + t * (d0 + t * (3 * (f1 - f0) - 2 * d0 - d1 + t * (2 * (f0 - f1) + d0 + d1))); }
  float slope(float t) const {
    return d0 + t * (6 * (f1 - f0) - 4 * d0 - 2 * d1 + t * (6 * (f0 - f1) + 3 * (d0 + d1)));
  }
  /// Integral over t from 0.
  float integral(float t) const {
    return t * (f0 + t * (d0 / 2 + t * (f1 - f0 - (2 * d0 + d1) / 3 + t * ((f0 - f1) / 2 + (d0 + d1) / 4))));
  }
};

/// Segment from nodes[i] to nodes[i + 1] of the Catmull-Rom spline: its derivatives are central differences, at the
/// first and last node one-sided ones. `value(k)`: value at node k.
template <class Value>
CubicSegment catmull_rom(std::span<const float> nodes, size_t i, const Value& value) {
  const float f0 = value(i), f1 = value(i + 1), width = nodes[i + 1] - nodes[i];
  return {f0, f1, i > 0 ? width * (f1 - value(i - 1)) / (nodes[i + 1] - nodes[i - 1]) : f1 - f0,
          i + 2 < nodes.size() ? width * (value(i + 2) - f0) / (nodes[i + 2] - nodes[i]) : f1 - f0};
}

/// Index of the segment that contains x, from 0 to nodes - 2. `node(k)`: ascending in k.
template <class Node>
size_t segment_of(size_t nodes, float x, const Node& node) {
  size_t low = 0, high = nodes - 1;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    (node(middle) <= x ? low : high) = middle;
  }
  return low;
}

/// Root in [0, 1] of an increasing function by Newton's method, with bisection where it leaves the bracket.
template <class Function, class Slope>
float increasing_root(const Function& function, const Slope& slope) {
  constexpr int kMost = 40;
  constexpr float kStep = 1e-6f;
  float low = 0, high = 1, t = 0.5f;
  for (int i = 0; i < kMost && high - low > kStep; ++i) {
    const float value = function(t), before = t;
    (value < 0 ? low : high) = t;
    t -= value / slope(t);
    if (!(t > low && t < high)) t = (low + high) / 2;
    if (std::abs(t - before) < kStep) break;
  }
  return t;
}

}  // namespace frond
