#include "scene/geometry/embree_surfaces.h"

#include <algorithm>

#include "scene/geometry/triangle.h"

namespace frond::embree {
namespace {

/// Returns a texture lookup point on a mesh, in the space of the containing object.
TexturePoint texture_point(const Surface& surface, const RTCHit& hit) {
  const Triangle t(*std::get<MeshPtr>(surface.geometry), hit.primID, {hit.u, hit.v});
  return {.uv = t.uv(), .p = t.p(), .n = normalize_any(Vec3{hit.Ng_x, hit.Ng_y, hit.Ng_z})};
}
/// Returns a texture lookup point on an analytic shape, in the space of the containing object.
TexturePoint texture_point(const AnalyticShape& shape, unsigned primitive, const ShapePoint& at) {
  return {.uv = shape.uv(primitive, at.at), .p = at.p, .n = normalize_any(at.ng)};
}

/// Stochastic alpha test: decided by a hash of the ray and the primitive, so that it does not depend on Embree's
/// traversal order. `layer` counts the crossings of one primitive along the ray.
bool intersects_box(const Surface& surface, const Target& target, const TexturePoint& at, const Query& query,
                    const Lane& lane, unsigned layer = 0) {
  const float alpha = surface.alpha->evaluate(at);
  if (alpha >= 1) return false;
  RandomStream random(
      hash_key(lane.key, (uint64_t(target.geometry) << 32) | target.primitive, query.instance_key(), uint64_t(layer)));
  return random.uniform() >= alpha;
}

template <class Context>
Query& query_of(Context* context) {
  return *reinterpret_cast<Query*>(context);
}

/// Calls `act` for a ray of a query. Returns false if it threw: Embree would lose the exception, so that the query
/// keeps it.
template <class Act>
bool attempt(Query& query, const Act& act) {
  try {
    act();
    return true;
  } catch (...) {
    if (!query.error) query.error = std::current_exception();
    return false;
  }
}

/// Embree's filter callback: rejects hits on meshes that fail the alpha test.
void filter_alpha(const RTCFilterFunctionNArguments* args) {
  const auto& surface = *static_cast<const Surface*>(args->geometryUserPtr);
  Query& query = query_of(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    attempt(query, [&] {
      const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, i);
      if (intersects_box(surface, {hit.geomID, hit.primID}, texture_point(surface, hit), query, query.lane[i]))
        args->valid[i] = 0;
    });
  }
}

/// Embree's intersection callback for analytic shapes.
void intersect_analytic(const RTCIntersectFunctionNArguments* args) {
  const auto& surface = *static_cast<const Surface*>(args->geometryUserPtr);
  Query& query = query_of(args->context);
  const Target target{args->geomID, args->primID};
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    attempt(query, [&] {
      const Ray ray = to_ray(rtcGetRayFromRayN(rays, args->N, i));
      if (const auto point = intersect_shape(surface, target, ray, query, query.lane[i]))
        report(*point, target, args->rayhit, args->N, i, query);
    });
  }
}

/// Embree's occlusion callback for analytic shapes.
void occluded_analytic(const RTCOccludedFunctionNArguments* args) {
  const auto& surface = *static_cast<const Surface*>(args->geometryUserPtr);
  Query& query = query_of(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    attempt(query, [&] {
      const Ray ray = to_ray(rtcGetRayFromRayN(args->ray, args->N, i));
      if (intersect_shape(surface, {args->geomID, args->primID}, ray, query, query.lane[i]))
        RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
    });
  }
}

/// Embree's bounds callback for analytic shapes.
void bounds_analytic(const RTCBoundsFunctionArguments* args) {
  const auto& surface = *static_cast<const Surface*>(args->geometryUserPtr);
  const Bounds b = std::get<AnalyticShapePtr>(surface.geometry)->bounds(args->primID);
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

/// Creates a triangle geometry, which shares the mesh's index buffer.
RTCGeometry mesh_geometry(RTCDevice device, const Surface& surface) {
  const TriangleMesh& mesh = *std::get<MeshPtr>(surface.geometry);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             sizeof(mesh.triangles[0]), mesh.triangles.size());
  // Embree reads 16 bytes for the last vertex; its own buffer is padded.
  void* vertices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.p.size());
  std::copy(mesh.p.begin(), mesh.p.end(), static_cast<Vec3*>(vertices));
  if (surface.alpha) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter_alpha);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_alpha);
  }
  return geometry;
}

/// Creates a user geometry with one primitive for each primitive of the shape.
RTCGeometry analytic_geometry(RTCDevice device, const Surface& surface) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, std::get<AnalyticShapePtr>(surface.geometry)->count());
  rtcSetGeometryBoundsFunction(geometry, bounds_analytic, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_analytic);
  rtcSetGeometryOccludedFunction(geometry, occluded_analytic);
  return geometry;
}

/// Embree's callbacks for a scene within a scene: traversal continues in it, with the same ray.
struct SceneCallbacks {
  static RTCScene scene(void* data) { return static_cast<RTCScene>(data); }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    rtcGetSceneBounds(scene(args->geometryUserPtr), args->bounds_o);
  }
  static void intersect(const RTCIntersectFunctionNArguments* args) {
    RTCScene inner = scene(args->geometryUserPtr);
    Query& query = query_of(args->context);
    if (args->N == RayPacket::kWidth)
      embree::intersect(args->valid, inner, *reinterpret_cast<RTCRayHit8*>(args->rayhit), query);
    else if (args->valid[0])
      embree::intersect(inner, *reinterpret_cast<RTCRayHit*>(args->rayhit), query);
  }
  static void occluded(const RTCOccludedFunctionNArguments* args) {
    RTCScene inner = scene(args->geometryUserPtr);
    Query& query = query_of(args->context);
    if (args->N == RayPacket::kWidth)
      embree::occluded(args->valid, inner, *reinterpret_cast<RTCRay8*>(args->ray), query);
    else if (args->valid[0])
      embree::occluded(inner, *reinterpret_cast<RTCRay*>(args->ray), query);
  }
};

}  // namespace

std::optional<ShapePoint> intersect_shape(const Surface& surface, const Target& target, const Ray& ray,
                                          const Query& query, const Lane& lane) {
  const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
  auto point = shape.intersect(target.primitive, ray, 0);
  for (unsigned layer = 0;
       point && surface.alpha &&
       intersects_box(surface, target, texture_point(shape, target.primitive, *point), query, lane, layer);
       ++layer) {
    const float behind = point->t;
    point = shape.intersect(target.primitive, ray, behind);
    if (point && !(point->t > behind)) return {};  // ignores a shape that returns a point before `behind`
  }
  if (point && !(point->t > 0 && point->t < INFINITY)) return {};
  return point;
}

/// Embree has no field for the hit point; it is stored in the ray's lane.
void report(const ShapePoint& point, const Target& target, RTCRayHitN* rays, unsigned n, unsigned i, Query& query) {
  RTCRayN_tfar(RTCRayHitN_RayN(rays, n), n, i) = point.t;
  query.lane[i].p = point.p;
  RTCHitN* hit = RTCRayHitN_HitN(rays, n);
  RTCHitN_Ng_x(hit, n, i) = point.ng.x, RTCHitN_Ng_y(hit, n, i) = point.ng.y, RTCHitN_Ng_z(hit, n, i) = point.ng.z;
  RTCHitN_u(hit, n, i) = point.at.x, RTCHitN_v(hit, n, i) = point.at.y;
  RTCHitN_primID(hit, n, i) = target.primitive, RTCHitN_geomID(hit, n, i) = target.geometry;
  RTCHitN_instID(hit, n, i, 0) = query.base.instID[0];
}

/// The surface is stored as user data and must outlive the geometry.
RTCGeometry new_geometry(RTCDevice device, const Surface& surface) {
  RTCGeometry geometry = std::holds_alternative<MeshPtr>(surface.geometry) ? mesh_geometry(device, surface)
                                                                           : analytic_geometry(device, surface);
  rtcSetGeometryUserData(geometry, const_cast<Surface*>(&surface));
  rtcCommitGeometry(geometry);
  return geometry;
}

RTCGeometry new_geometry(RTCDevice device, RTCScene scene) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryBoundsFunction(geometry, SceneCallbacks::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, SceneCallbacks::intersect);
  rtcSetGeometryOccludedFunction(geometry, SceneCallbacks::occluded);
  rtcSetGeometryUserData(geometry, scene);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace frond::embree
