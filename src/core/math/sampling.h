#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/vec.h"

namespace frond {

/// Sine and cosine of an angle in [-pi / 4, pi / 4] by their Taylor series; absolute error at most 7e-8.
struct SineCosine {
  float sine, cosine;

  explicit SineCosine(float a) {
    const float s = a * a;
    sine = a * (1 + s * (-1.f / 6 + s * (1.f / 120 + s * (-1.f / 5040 + s * (1.f / 362880)))));
    cosine = 1 + s * (-1.f / 2 + s * (1.f / 24 + s * (-1.f / 720 + s * (1.f / 40320 + s * (-1.f / 3628800)))));
  }
};

/// Uniform point of the unit disk: the concentric, area-preserving map of the unit square (Shirley and Chiu 1997).
inline Vec2 sample_disk(Vec2 u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {};
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y;
  const SineCosine of(kPi / 4 * ((wide ? y : x) / r));
  return {r * (wide ? of.cosine : of.sine), r * (wide ? of.sine : of.cosine)};
}

/// Unit vector in the hemisphere around +z with density cos(theta) / pi per solid angle.
inline Vec3 sample_cosine_hemisphere(Vec2 u) {
  const Vec2 d = sample_disk(u);
  return {d.x, d.y, std::sqrt(std::max(0.f, 1 - d.x * d.x - d.y * d.y))};
}

/// Stretches a number that lies in [begin, end) to [0, 1). A number that has chosen one of several lobes then samples
/// that lobe: a stratified set of pairs gives each lobe an even set, which separate numbers for the choice would not.
inline float remap_sample(float u, float begin, float end) {
  constexpr float kBelowOne = 0x1.fffffep-1f;
  return std::min((u - begin) / (end - begin), kBelowOne);
}

/// MIS weight, by the power heuristic with exponent 2, of a sample from density `a` beside one sample from density `b`
/// (Veach and Guibas 1995): a^2 / (a^2 + b^2); 1 if `a` is infinite, 0 if it is 0.
inline float power_heuristic(float a, float b) {
  if (std::isinf(a)) return 1;
  if (!(a > 0)) return 0;
  const float ratio = b / a;  // the squares themselves can overflow
  return 1 / (1 + ratio * ratio);
}

}  // namespace frond
