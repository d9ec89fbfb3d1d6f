#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec.h"

namespace frond {

/// Sine and cosine of an angle within pi / 4 of 0, by their series; to 7e-8.
struct SineCosine {
  float sine, cosine;

  explicit SineCosine(float a) {
    const float s = a * a;
    sine = a * (1 + s * (-1.f / 6 + s * (1.f / 120 + s * (-1.f / 5040 + s * (1.f / 362880)))));
    cosine = 1 + s * (-1.f / 2 + s * (1.f / 24 + s * (-1.f / 720 + s * (1.f / 40320 + s * (-1.f / 3628800)))));
  }
};

/// Unit square to unit disk, area preserving (Shirley and Chiu 1997).
inline Vec2 sample_disk(Vec2 u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {};
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y;
  const SineCosine of(kPi / 4 * ((wide ? y : x) / r));
  return {r * (wide ? of.cosine : of.sine), r * (wide ? of.sine : of.cosine)};
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
