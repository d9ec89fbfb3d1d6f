#pragma once

#include <cstddef>
#include <cstring>

#include "core/math/float4.h"
#include "scene/geometry/embree.h"
#include "scene/geometry/geometry.h"

namespace frond::embree {

/// Returns an Embree geometry of a surface, which must outlive it. Queries must use the context Query.
RTCGeometry new_geometry(RTCDevice device, const Surface& surface);

/// Returns an Embree geometry whose single primitive is a committed scene, which must outlive it. Hits keep the scene's
/// geometry IDs.
RTCGeometry new_geometry(RTCDevice device, RTCScene scene);

/// Bounds of a committed scene.
inline Bounds bounds_of(RTCScene scene) {
  RTCBounds b;
  rtcGetSceneBounds(scene, &b);
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

inline Ray to_ray(const RTCRay& r) {
  return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar, r.time};
}
/// The fourth lane is 0.
inline Float4 origin(const RTCRay& r) { return Float4{r.org_x, r.org_y, r.org_z, 0}; }
inline Float4 direction(const RTCRay& r) { return Float4{r.dir_x, r.dir_y, r.dir_z, 0}; }

/// The fourth lane of `o` must be 0; the fourth lane of `d` is replaced by the time. The ray is written in two halves
/// of 16 bytes, as Embree loads it; four single stores would stall store forwarding.
inline RTCRay from_vectors(Float4 o, Float4 d, float t_max, float time) {
  RTCRay ray;
  d[3] = time;
  static_assert(offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 && offsetof(RTCRay, time) == 28);
  auto* const bytes = reinterpret_cast<std::byte*>(&ray);
  std::memcpy(bytes, &o, sizeof o);
  std::memcpy(bytes + 16, &d, sizeof d);
  ray.tfar = t_max, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
  return ray;
}
/// Converts a ray, with all mask bits set.
inline RTCRay from_ray(const Ray& r) {
  return from_vectors(Float4{r.o.x, r.o.y, r.o.z, 0}, Float4{r.d.x, r.d.y, r.d.z, 0}, r.t_max, r.time);
}

/// Geometry and primitive of a hit, in Embree's numbering.
struct Target {
  unsigned geometry, primitive;
};

/// Returns the nearest point at which an analytic surface stops the ray, if any. Points with alpha 0 are skipped.
std::optional<ShapePoint> intersect_shape(const Surface& surface, const Target& target, const Ray& ray,
                                          const Query& query, const Lane& lane);

/// Stores the point as the hit of ray i of N.
void report(const ShapePoint& point, const Target& target, RTCRayHitN* rays, unsigned n, unsigned i, Query& query);

}  // namespace frond::embree
