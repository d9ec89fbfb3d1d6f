#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/distribution.h"

namespace frond {

/// Octahedral map from the unit square to the upper hemisphere. It is not equal-area, but needs no arc tangent.
inline Vec3 hemisphere_from_square(Vec2 uv) {
  const float x = uv.x + uv.y - 1, y = uv.x - uv.y;
  return normalize_any(Vec3{x, y, std::max(0.f, 1 - std::abs(x) - std::abs(y))});
}
/// Returns the sum of a direction's absolute coordinates. The map's solid angle per area is twice its cube.
inline float octahedral_norm(const Vec3& d) { return std::abs(d.x) + std::abs(d.y) + d.z; }
inline float solid_angle_per_area(float norm) { return 2 * norm * norm * norm; }

/// Piecewise constant density over the square that is mapped to the hemisphere.
class HemisphereTable {
 public:
  /// `weights`: row by row, kSide in each.
  explicit HemisphereTable(const std::vector<float>& weights) : cells_(weights, kSide) {
    for (size_t i = 0; i < weights.size(); ++i) densities_.push_back(cells_.pdf(center(i)));
  }
  /// Returns the point of the square at a place in a cell; `offset` in [0, 1)^2.
  static Vec2 point(size_t cell, Vec2 offset) {
    return {(float(cell % kSide) + offset.x) / kSide, (float(cell / kSide) + offset.y) / kSide};
  }
  static constexpr int kSide = 64;  ///< about 2 degrees

  struct Sample {
    Vec3 direction;
    float pdf;  ///< per solid angle
  };
  Sample sample(Vec2 u) const {
    const auto [uv, density] = cells_.sample(u);
    const Vec3 d = hemisphere_from_square(uv);
    return {d, density / solid_angle_per_area(octahedral_norm(d))};
  }
  /// Returns the density per solid angle; `d.z` > 0.
  float pdf(const Vec3& d) const {
    const float norm = octahedral_norm(d), x = d.x / norm, y = d.y / norm;
    const auto cell = [](float at) { return std::min(size_t(std::max(0.f, at * (kSide / 2.f))), size_t(kSide - 1)); };
    return densities_[cell(x - y + 1) * kSide + cell(x + y + 1)] / solid_angle_per_area(norm);
  }

 private:
  static Vec2 center(size_t cell) { return point(cell, {0.5f, 0.5f}); }

  Distribution2D cells_;
  std::vector<float> densities_;  ///< per area of the square, by cell
};

}  // namespace frond
