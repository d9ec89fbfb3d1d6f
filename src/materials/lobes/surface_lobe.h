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
    const Vec2 disk = sample_disk(u);
    const float r2 = disk.x * disk.x + disk.y * disk.y;
    if (r2 == 0) continue;
    const float cos_alpha = lobe.cos_from_uniform(1 - r2);
    const float s = std::sqrt(std::max(0.f, 1 - cos_alpha * cos_alpha) / r2);
    const Vec3 wi = normalize(frame.to_world({s * disk.x, s * disk.y, cos_alpha}));
    if (wi.z * wo.z > 0) return wi;
  }
}

}  // namespace frond
