#pragma once

#include <cstddef>
#include <cstring>

#include "core/float4.h"
#include "scene/geometry/embree.h"
#include "scene/geometry/geometry.h"

namespace frond::embree {

/// One surface for Embree, which it must outlive. Its queries are those of this folder: Query.
RTCGeometry new_geometry(RTCDevice device, const Surface& surface);

inline Ray to_ray(const RTCRay& r) { return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar}; }
/// Fourth lanes are 0.
inline Float4 origin(const RTCRay& r) { return Float4{r.org_x, r.org_y, r.org_z, 0}; }
inline Float4 direction(const RTCRay& r) { return Float4{r.dir_x, r.dir_y, r.dir_z, 0}; }

/// Fourth lanes have to be 0. Written in halves of 16 bytes, as Embree reads it: it would wait for four numbers written
/// one by one.
inline RTCRay from_vectors(Float4 o, Float4 d, float t_max) {
  RTCRay ray;
  static_assert(offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 && offsetof(RTCRay, time) == 28);
  auto* const bytes = reinterpret_cast<std::byte*>(&ray);
  std::memcpy(bytes, &o, sizeof o);
  std::memcpy(bytes + 16, &d, sizeof d);
  ray.tfar = t_max, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
  return ray;
}
inline RTCRay from_ray(const Ray& r) {
  return from_vectors(Float4{r.o.x, r.o.y, r.o.z, 0}, Float4{r.d.x, r.d.y, r.d.z, 0}, r.t_max);
}

/// Which of Embree's things a hit is on.
struct Target {
  unsigned geometry, primitive;
};

/// The point where an analytic surface stops a ray of the query, if it does: behind a sheet that lets it pass there may
/// be another.
std::optional<ShapePoint> meet(const Surface& surface, const Target& target, const Ray& ray, const Query& query,
                               const Lane& lane);

/// Makes that point the nearest of ray i of N.
void report(const ShapePoint& point, const Target& target, RTCRayHitN* rays, unsigned n, unsigned i, Query& query);

}  // namespace frond::embree
