#include "scene/geometry/embree_instances.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "scene/geometry/embree_surfaces.h"

namespace frond {
namespace {

/// The fourth lane has no meaning. It is 1 because 0 would make `intersects_box` multiply 0 by infinity.
Float4 to_float4(const Vec3& v) { return Float4{v.x, v.y, v.z, 1}; }

/// Whether a ray hits a box. The world-space box of an instance is larger than its object-space box, so most rays that
/// hit the former miss the latter.
bool intersects_box(Float4 origin, Float4 direction, float t_max, const Bounds& box) {
  const Float4 inverse = 1 / direction;
  const Float4 a = (to_float4(box.min) - origin) * inverse, b = (to_float4(box.max) - origin) * inverse;
  // NaN occurs if a ray lies in a face's plane. Either result is correct, because boxes are slightly enlarged.
  const Float4 near = b < a ? b : a, far = a < b ? b : a;
  const Float4 start{}, end = start + t_max;
  const Float4 enter = start < near ? near : start, leave = far < end ? far : end;
  return std::max({enter[0], enter[1], enter[2]}) <= std::min({leave[0], leave[1], leave[2]}) * (1 + 0x1p-20f);
}

using Float8 = float __attribute__((vector_size(32), may_alias));

// NOLINTNEXTLINE(readability-non-const-parameter): written through the result
Float8& lanes(float* x) { return *reinterpret_cast<Float8*>(x); }
const Float8& lanes(const float* x) { return *reinterpret_cast<const Float8*>(x); }

/// Transforms a packet of rays. `in` and `out` may be the same object.
void transform(const AffineMap::Inverse& map, const RTCRay8& in, RTCRay8& out) {
  const auto& [x, y, z, t] = map;
  const Float8 px = lanes(in.org_x) - t[0], py = lanes(in.org_y) - t[1], pz = lanes(in.org_z) - t[2];
  lanes(out.org_x) = x[0] * px + y[0] * py + z[0] * pz;
  lanes(out.org_y) = x[1] * px + y[1] * py + z[1] * pz;
  lanes(out.org_z) = x[2] * px + y[2] * py + z[2] * pz;
  const Float8 dx = lanes(in.dir_x), dy = lanes(in.dir_y), dz = lanes(in.dir_z);
  lanes(out.dir_x) = x[0] * dx + y[0] * dy + z[0] * dz;
  lanes(out.dir_y) = x[1] * dx + y[1] * dy + z[1] * dz;
  lanes(out.dir_z) = x[2] * dx + y[2] * dy + z[2] * dz;
  lanes(out.tnear) = lanes(in.tnear);
  lanes(out.tfar) = lanes(in.tfar);
  lanes(out.time) = lanes(in.time);
  std::memcpy(out.mask, in.mask, sizeof out.mask);
  std::memcpy(out.id, in.id, sizeof out.id);
  std::memcpy(out.flags, in.flags, sizeof out.flags);
}

/// Tests a packet. Sets `passing` for each ray; returns whether any ray hits.
bool intersects_box(const RTCRay8& rays, const Bounds& box, const int* valid, int* passing) {
  Float8 enter{}, leave = lanes(rays.tfar);
  const auto clip = [&](const float* origins, const float* directions, float low, float high) {
    const Float8 inverse = 1 / lanes(directions);
    const Float8 a = (low - lanes(origins)) * inverse, b = (high - lanes(origins)) * inverse;
    const Float8 near = a < b ? a : b, far = a < b ? b : a;
    enter = near > enter ? near : enter;
    leave = far < leave ? far : leave;
  };
  clip(rays.org_x, rays.dir_x, box.min.x, box.max.x);
  clip(rays.org_y, rays.dir_y, box.min.y, box.max.y);
  clip(rays.org_z, rays.dir_z, box.min.z, box.max.z);
  const auto inside = enter <= leave * (1 + 0x1p-20f);
  int any = 0;
  for (int i = 0; i < RayPacket::kWidth; ++i) any |= passing[i] = valid[i] & inside[i];
  return any != 0;
}

/// Embree's callbacks for instances of objects: they transform the ray into the object's space and continue traversal
/// there.
struct Callbacks {
  /// Returns false if the ray misses the object's box.
  static bool to_object(const embree::Instance& instance, const RTCRay& ray, RTCRay& inner) {
    const GeometryInstances& set = *static_cast<const GeometryInstances*>(instance.set);
    Float4 origin = embree::origin(ray), direction = embree::direction(ray);
    if (set.instances.is_placed) {
      origin = set.from_placement.point(origin);
      direction = set.from_placement.vector(direction);
    }
    AffineMap::Inverse made;
    const AffineMap::Inverse& map = set.inverse(instance.row, ray.time, made);
    inner = embree::from_vectors(map.point(origin), map.vector(direction), ray.tfar, ray.time);
    return intersects_box(embree::origin(inner), embree::direction(inner), ray.tfar, set.object(instance.row).bounds);
  }

  /// Embree's intersection callback, for single rays and for packets.
  static void intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& set = *static_cast<const GeometryInstances*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<embree::Query*>(args->context);
    const embree::Instance instance{&set, args->primID};
    if (args->N == RayPacket::kWidth) {
      intersect(instance, args->valid, *reinterpret_cast<RTCRayHit8*>(args->rayhit), query);
    } else if (args->valid[0]) {
      intersect(instance, *reinterpret_cast<RTCRayHit*>(args->rayhit), query);
    }
  }

  /// Embree's occlusion callback, for single rays and for packets.
  static void occluded(const RTCOccludedFunctionNArguments* args) {
    const auto& set = *static_cast<const GeometryInstances*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<embree::Query*>(args->context);
    const embree::Instance instance{&set, args->primID};
    if (args->N == RayPacket::kWidth) {
      occluded(instance, args->valid, *reinterpret_cast<RTCRay8*>(args->ray), query);
    } else if (args->valid[0]) {
      occluded(instance, *reinterpret_cast<RTCRay*>(args->ray), query);
    }
  }

  /// Intersects one ray with an instance. On a hit, the instance path is stored in the ray's lane.
  static void intersect(const embree::Instance& instance, RTCRayHit& ray, embree::Query& query) {
    const auto& set = *static_cast<const GeometryInstances*>(instance.set);
    RTCRayHit nested;
    if (!to_object(instance, ray.ray, nested.ray)) return;
    const GeometryObject& object = set.object(instance.row);
    const uint32_t level = query.depth;
    query.enter(instance);
    if (object.only_primitive) {
      constexpr embree::Target kOnly{0, 0};
      const Ray inner = embree::to_ray(nested.ray);
      if (const auto point = embree::intersect_shape(*object.only_primitive, kOnly, inner, query, *query.lane)) {
        embree::report(*point, kOnly, reinterpret_cast<RTCRayHitN*>(&ray), 1, 0, query);
        query.lane->hit[level] = instance;
      }
    } else {
      nested.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      embree::intersect(object.scene.get(), nested, query);
      if (nested.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        ray.ray.tfar = nested.ray.tfar;
        ray.hit = nested.hit;
        query.lane->hit[level] = instance;
      }
    }
    query.leave();
  }

  /// Tests one ray against an instance for occlusion.
  static void occluded(const embree::Instance& instance, RTCRay& ray, embree::Query& query) {
    const auto& set = *static_cast<const GeometryInstances*>(instance.set);
    RTCRay nested;
    if (!to_object(instance, ray, nested)) return;
    const GeometryObject& object = set.object(instance.row);
    query.enter(instance);
    if (object.only_primitive) {
      if (embree::intersect_shape(*object.only_primitive, {0, 0}, embree::to_ray(nested), query, *query.lane))
        ray.tfar = -INFINITY;
    } else {
      embree::occluded(object.scene.get(), nested, query);
      if (nested.tfar < 0) ray.tfar = -INFINITY;
    }
    query.leave();
  }

  /// Each ray of a packet has its own time, and so its own transform.
  static void to_moving_object(const embree::Instance& instance, const int* valid, const RTCRay8& rays,
                               RTCRay8& inner) {
    transform(AffineMap::Inverse{}, rays, inner);  // sets all but origins and directions
    for (size_t i = 0; i < RayPacket::kWidth; ++i) {
      if (!valid[i]) continue;
      RTCRay nested;
      (void)to_object(
          instance,
          rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(const_cast<RTCRay8*>(&rays)), RayPacket::kWidth, unsigned(i)),
          nested);
      inner.org_x[i] = nested.org_x, inner.org_y[i] = nested.org_y, inner.org_z[i] = nested.org_z;
      inner.dir_x[i] = nested.dir_x, inner.dir_y[i] = nested.dir_y, inner.dir_z[i] = nested.dir_z;
    }
  }

  /// Transforms a packet and tests the object's box. Returns false if all rays miss.
  static bool to_object(const embree::Instance& instance, const int* valid, const RTCRay8& rays, RTCRay8& inner,
                        int* passing) {
    const GeometryInstances& set = *static_cast<const GeometryInstances*>(instance.set);
    AffineMap::Inverse made;
    if (!set.instances.motions.empty()) {
      to_moving_object(instance, valid, rays, inner);
    } else if (set.instances.is_placed) {
      transform(set.from_placement, rays, inner);
      transform(set.inverse(instance.row, 0, made), inner, inner);
    } else {
      transform(set.inverse(instance.row, 0, made), rays, inner);
    }
    return intersects_box(inner, set.object(instance.row).bounds, valid, passing);
  }

  /// Intersects a packet. Rays that miss the object's box are masked out.
  static void intersect(const embree::Instance& instance, const int* valid, RTCRayHit8& rays, embree::Query& query) {
    RTCRayHit8 inner;
    alignas(32) std::array<int, RayPacket::kWidth> passing;
    if (!to_object(instance, valid, rays.ray, inner.ray, passing.data())) return;
    std::ranges::fill(inner.hit.geomID, RTC_INVALID_GEOMETRY_ID);
    const uint32_t level = query.depth;
    query.enter(instance);
    embree::intersect(passing.data(),
                      static_cast<const GeometryInstances*>(instance.set)->object(instance.row).scene.get(), inner,
                      query);
    query.leave();
    for (unsigned i = 0; i < RayPacket::kWidth; ++i) {
      if (!passing[i] || inner.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      rays.ray.tfar[i] = inner.ray.tfar[i];
      const RTCHit at = rtcGetHitFromHitN(reinterpret_cast<RTCHitN*>(&inner.hit), RayPacket::kWidth, i);
      rtcCopyHitToHitN(reinterpret_cast<RTCHitN*>(&rays.hit), &at, RayPacket::kWidth, i);
      query.lane[i].hit[level] = instance;
    }
  }

  /// Tests a packet for occlusion.
  static void occluded(const embree::Instance& instance, const int* valid, RTCRay8& rays, embree::Query& query) {
    RTCRay8 inner;
    alignas(32) std::array<int, RayPacket::kWidth> passing;
    if (!to_object(instance, valid, rays, inner, passing.data())) return;
    query.enter(instance);
    embree::occluded(passing.data(),
                     static_cast<const GeometryInstances*>(instance.set)->object(instance.row).scene.get(), inner,
                     query);
    query.leave();
    for (unsigned i = 0; i < RayPacket::kWidth; ++i)
      if (passing[i] && inner.tfar[i] < 0) rays.tfar[i] = -INFINITY;
  }

  /// World bounds of an instance: the transformed outline is tighter than a transformed box. Embree interpolates the
  /// bounds of a moving one linearly between its time steps, and outlines move along curves.
  static void bounds_instances(const RTCBoundsFunctionArguments* args) {
    const auto& set = *static_cast<const GeometryInstances*>(args->geometryUserPtr);
    const Instances& i = set.instances;
    const AffineMap map = i.map(args->primID, float(args->timeStep) / float(set.parts()));
    Bounds b;
    for (const Vec3& corner : set.object(args->primID).outline) {
      const Vec3 p = map.point(corner);
      b.add(i.is_placed ? i.placement.point(p) : p);
    }
    if (!i.motions.empty() && !b.is_empty()) {
      float size = 0;
      for (const Vec3& corner : set.object(args->primID).outline) size = std::max(size, length(corner));
      const float slack = i.motions[args->primID].deviation(set.parts(), size);
      b = {b.min - Vec3{slack, slack, slack}, b.max + Vec3{slack, slack, slack}};
    }
    b = widened(b);  // points are rounded by the map, rays by its inverse
    *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
  }
};

}  // namespace

/// `set` is stored as user data and must outlive the geometry.
RTCGeometry embree::new_geometry(RTCDevice device, const GeometryInstances& set) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(set.instances.table->size()));
  if (!set.instances.motions.empty()) rtcSetGeometryTimeStepCount(geometry, set.parts() + 1);
  rtcSetGeometryBoundsFunction(geometry, Callbacks::bounds_instances, nullptr);
  rtcSetGeometryIntersectFunction(geometry, Callbacks::intersect);
  rtcSetGeometryOccludedFunction(geometry, Callbacks::occluded);
  rtcSetGeometryUserData(geometry, const_cast<GeometryInstances*>(&set));
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace frond
