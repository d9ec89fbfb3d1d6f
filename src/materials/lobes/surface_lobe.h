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

inline Vec3 sample_surface_lobe(const leaf::Lobe& lobe, const Vec3& wo, Vec2 u, RandomStream& rng) {
  const Frame frame = Frame::around(Vec3{-wo.x, -wo.y, wo.z});
  for (;; u = {rng.uniform(), rng.uniform()}) {
    const float cos_alpha = lobe.cos_from_uniform(1 - u.x), beta = 2 * kPi * u.y;
    const float sin_alpha = std::sqrt(std::max(0.f, 1 - cos_alpha * cos_alpha));
    const Vec3 wi = frame.to_world({sin_alpha * std::cos(beta), sin_alpha * std::sin(beta), cos_alpha});
    if (wi.z * wo.z > 0) return normalize(wi);
  }
}

}  // namespace frond
