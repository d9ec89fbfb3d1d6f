#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace frond {

/// Unit square to unit disk, area preserving (Shirley and Chiu 1997).
inline Vec2 sample_disk(Vec2 u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {};
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y, phi = wide ? kPi / 4 * (y / x) : kPi / 2 - kPi / 4 * (x / y);
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Direction with density cos(theta) / pi about +z.
inline Vec3 sample_cosine_hemisphere(Vec2 u) {
  const Vec2 d = sample_disk(u);
  return {d.x, d.y, std::sqrt(std::max(0.f, 1 - d.x * d.x - d.y * d.y))};
}

/// Weight of a strategy of density `a` against one of density `b`, one sample each (Veach and Guibas 1995).
inline float power_heuristic(float a, float b) {
  if (std::isinf(a)) return 1;
  if (!(a > 0)) return 0;
  const float ratio = b / a;  // the squares themselves can overflow
  return 1 / (1 + ratio * ratio);
}

}  // namespace frond
