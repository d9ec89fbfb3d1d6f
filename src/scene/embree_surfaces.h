#pragma once

#include "core/float4.h"
#include "scene/embree.h"
#include "scene/geometry.h"

namespace frond::embree {

/// One surface for Embree, which it must outlive. Its queries are those of this folder: Query.
RTCGeometry new_geometry(RTCDevice device, const Surface& surface);

inline Ray to_ray(const RTCRay& r) { return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar}; }
inline RTCRay from_ray(const Ray& r) { return {r.o.x, r.o.y, r.o.z, 0, r.d.x, r.d.y, r.d.z, 0, r.t_max, ~0u, 0, 0}; }

/// The same in registers; fourth lanes are 0.
inline Float4 origin(const RTCRay& r) { return Float4{r.org_x, r.org_y, r.org_z, 0}; }
inline Float4 direction(const RTCRay& r) { return Float4{r.dir_x, r.dir_y, r.dir_z, 0}; }
inline RTCRay from_vectors(Float4 o, Float4 d, float t_max) {
  return {o[0], o[1], o[2], 0, d[0], d[1], d[2], 0, t_max, ~0u, 0, 0};
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
