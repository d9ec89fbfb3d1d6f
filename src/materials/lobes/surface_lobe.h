#pragma once

#include "core/sampling.h"
#include "core/vec.h"
#include "leaf/lobe.h"

namespace frond {

/// The lobe about the mirror direction that a leaf's surface reflects into, cut off at the surface.

/// 1/sr; 0 on the other side.
inline float surface_lobe_pdf(const leaf::Lobe& lobe, const Vec3& wo, const Vec3& wi) {
  if (wo.z * wi.z <= 0) return 0;
  const Vec3 mirror{-wo.x, -wo.y, wo.z};
  return static_cast<float>(lobe.density(dot(mirror, wi)) / lobe.kept(std::abs(wo.z)));
}

/// (cos, sin) of 2 pi u, u in [0, 1], to 1e-6: by Taylor series of half the angle, quicker than a call.
inline Vec2 unit_circle(float u) {
  const float a = kPi * (u - 0.5f), a2 = a * a;
  const float s =
      a * (1 + a2 * (-1.f / 6 + a2 * (1.f / 120 + a2 * (-1.f / 5040 + a2 * (1.f / 362880 - a2 * (1.f / 39916800))))));
  const float c = 1 + a2 * (-1.f / 2 + a2 * (1.f / 24 + a2 * (-1.f / 720 + a2 * (1.f / 40320 - a2 * (1.f / 3628800)))));
  return {2 * s * s - 1, -2 * s * c};
}

inline Vec3 sample_surface_lobe(const leaf::Lobe& lobe, const Vec3& wo, Vec2 u, RandomStream& rng) {
  const Frame frame = Frame::around(Vec3{-wo.x, -wo.y, wo.z});
  for (;; u = {rng.uniform(), rng.uniform()}) {
    const float cos_alpha = lobe.cos_from_uniform(1 - u.x);
    const float sin_alpha = std::sqrt(std::max(0.f, 1 - cos_alpha * cos_alpha));
    const Vec2 d = unit_circle(u.y);
    const Vec3 wi = frame.to_world({sin_alpha * d.x, sin_alpha * d.y, cos_alpha});
    if (wi.z * wo.z > 0) return wi * (1.5f - 0.5f * dot(wi, wi));  // a Newton step to unit length
  }
}

}  // namespace frond
