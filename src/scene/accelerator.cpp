#include "scene/accelerator.h"

#include <array>

#include "core/error.h"
#include "scene/embree.h"

namespace frond {
namespace {

struct Triangle {
  std::array<uint32_t, 3> index;
  float b0, b1, b2;

  template <class T>
  T interpolate(const std::vector<T>& values) const {
    return values[index[0]] * b0 + values[index[1]] * b1 + values[index[2]] * b2;
  }
};

Triangle triangle_at(const TriangleMesh& mesh, unsigned primitive, float u, float v) {
  return {mesh.triangles[primitive], 1 - u - v, u, v};
}

Vec2 uv_at(const Primitive& primitive, unsigned index, float u, float v) {
  if (!std::holds_alternative<MeshPtr>(primitive.geometry)) return {u, v};
  const TriangleMesh& mesh = *std::get<MeshPtr>(primitive.geometry);
  return mesh.uv.empty() ? Vec2{u, v} : triangle_at(mesh, index, u, v).interpolate(mesh.uv);
}

/// Whether a ray passes a partly transparent surface: decided for each ray and primitive, in whatever order Embree
/// asks.
/// `layer` counts the sheets of one primitive along the ray.
bool passes(const Primitive& primitive, Vec2 uv, uint64_t key, unsigned geometry, unsigned index, unsigned instance,
            unsigned layer = 0) {
  const float alpha = primitive.alpha->evaluate(uv);
  if (alpha >= 1) return false;
  RandomStream random(hash_key(key, (uint64_t(geometry) << 32) | index, instance, layer));
  return random.uniform() >= alpha;
}

template <class Context>
uint64_t key_of(const Context* context) {
  return reinterpret_cast<const embree::Query*>(context)->key;
}

void filter_alpha(const RTCFilterFunctionNArguments* args) {
  const auto& primitive = *static_cast<const Primitive*>(args->geometryUserPtr);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const Vec2 uv = uv_at(primitive, hit.primID, hit.u, hit.v);
  if (passes(primitive, uv, key_of(args->context), hit.geomID, hit.primID, hit.instID[0])) args->valid[0] = 0;
}

Ray ray_of(const RTCRay& r) { return {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar}; }

/// The point where the analytic primitive stops the ray, if it does: behind a sheet that lets it pass there may be
/// another.
template <class Arguments>
std::optional<ShapePoint> meet(const Arguments* args, const RTCRay& embree_ray) {
  const auto& primitive = *static_cast<const Primitive*>(args->geometryUserPtr);
  const AnalyticShape& shape = *std::get<AnalyticShapePtr>(primitive.geometry);
  const Ray ray = ray_of(embree_ray);
  auto point = shape.intersect(args->primID, ray, embree_ray.tnear);
  for (unsigned layer = 0; point && primitive.alpha; ++layer) {
    if (!passes(primitive, point->uv, key_of(args->context), args->geomID, args->primID, args->context->instID[0],
                layer))
      break;
    point = shape.intersect(args->primID, ray, point->t);
  }
  return point;
}

void intersect_analytic(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& ray_hit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const auto point = meet(args, ray_hit.ray);
  if (!point) return;
  ray_hit.ray.tfar = point->t;
  reinterpret_cast<embree::Query*>(args->context)->p = point->p;
  RTCHit& hit = ray_hit.hit;
  hit.Ng_x = point->ng.x, hit.Ng_y = point->ng.y, hit.Ng_z = point->ng.z;
  hit.u = point->uv.x, hit.v = point->uv.y;
  hit.primID = args->primID, hit.geomID = args->geomID, hit.instID[0] = args->context->instID[0];
}

void occluded_analytic(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  if (meet(args, ray)) ray.tfar = -INFINITY;
}

void bounds_analytic(const RTCBoundsFunctionArguments* args) {
  const auto& primitive = *static_cast<const Primitive*>(args->geometryUserPtr);
  const Bounds b = std::get<AnalyticShapePtr>(primitive.geometry)->bounds(args->primID);
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

RTCGeometry mesh_geometry(RTCDevice device, const Primitive& primitive) {
  const TriangleMesh& mesh = *std::get<MeshPtr>(primitive.geometry);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             sizeof(mesh.triangles[0]), mesh.triangles.size());
  // Embree reads 16 bytes at the last vertex: a copy that it pads itself.
  void* vertices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.p.size());
  std::copy(mesh.p.begin(), mesh.p.end(), static_cast<Vec3*>(vertices));
  if (primitive.alpha) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter_alpha);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_alpha);
  }
  return geometry;
}

RTCGeometry analytic_geometry(RTCDevice device, const Primitive& primitive) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, std::get<AnalyticShapePtr>(primitive.geometry)->count());
  rtcSetGeometryBoundsFunction(geometry, bounds_analytic, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_analytic);
  rtcSetGeometryOccludedFunction(geometry, occluded_analytic);
  return geometry;
}

RTCRay to_embree(const Ray& ray) {
  return {ray.o.x, ray.o.y, ray.o.z, 0, ray.d.x, ray.d.y, ray.d.z, 0, ray.t_max, ~0u, 0, 0};
}

Vec3 face_forward(const Vec3& n, const Vec3& reference) { return dot(n, reference) < 0 ? -n : n; }

/// Where the surface is so small, or its vertex normals so contrary, that there is no normal, the next best: no NaN.
void set_frame(Hit& hit, const Vec3& ng, const Vec3& ns, const Vec3& direction) {
  const Vec3 geometric = normalize_any(ng), shading = normalize_any(ns);
  hit.ng = geometric == Vec3{} ? -direction : geometric;
  hit.shading = Frame::around(shading == Vec3{} ? hit.ng : face_forward(shading, hit.ng));
}

float largest_coordinate(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Everything but the material, in the space of the group.
void fill_triangle(const TriangleMesh& mesh, const RTCHit& hit, Hit& out, Vec3& ns) {
  const Triangle t = triangle_at(mesh, hit.primID, hit.u, hit.v);
  out.p = t.interpolate(mesh.p);
  for (const uint32_t i : t.index) out.extent = std::max(out.extent, largest_coordinate(mesh.p[i]));
  out.ng = cross(mesh.p[t.index[1]] - mesh.p[t.index[0]], mesh.p[t.index[2]] - mesh.p[t.index[0]]);
  ns = mesh.n.empty() ? out.ng : t.interpolate(mesh.n);
  out.uv = mesh.uv.empty() ? Vec2{hit.u, hit.v} : t.interpolate(mesh.uv);
}

}  // namespace

void embree::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void embree::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Accelerator::Accelerator(std::vector<Primitive> top, std::vector<std::vector<Primitive>> groups,
                         const std::vector<Placement>& instances, int threads)
    : top_(std::move(top)), groups_(std::move(groups)) {
  // AVX-512 gains nothing for single rays, and changes the last bits of hits.
  device_.reset(rtcNewDevice(fmt::format("max_isa=avx2,threads={}", threads).c_str()));
  if (!device_) fail({}, "Embree cannot start: error {}", int(rtcGetDeviceError(nullptr)));
  for (const auto& group : groups_) {
    group_scenes_.emplace_back(rtcNewScene(device_.get()));
    rtcSetSceneFlags(group_scenes_.back().get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips between triangles
    attach(group_scenes_.back().get(), group);
    rtcCommitScene(group_scenes_.back().get());
  }
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  attach(scene_.get(), top_);
  attach(scene_.get(), instances);
  rtcCommitScene(scene_.get());
  check();
}

void Accelerator::check() const {
  if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
    fail({}, "Embree cannot build the scene: {}",
         error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", int(error)));
}

void Accelerator::attach(RTCScene scene, const std::vector<Primitive>& primitives) {
  for (unsigned i = 0; i < primitives.size(); ++i) {
    const Primitive& primitive = primitives[i];
    const bool is_mesh = std::holds_alternative<MeshPtr>(primitive.geometry);
    RTCGeometry geometry =
        is_mesh ? mesh_geometry(device_.get(), primitive) : analytic_geometry(device_.get(), primitive);
    rtcSetGeometryUserData(geometry, const_cast<Primitive*>(&primitive));
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, i);
    rtcReleaseGeometry(geometry);
  }
}

void Accelerator::attach(RTCScene scene, const std::vector<Placement>& instances) {
  instances_.reserve(instances.size());
  for (const Placement& placement : instances) {
    const Transform& t = placement.world_from_object;
    const Vec3 x = t.vector({1, 0, 0}), y = t.vector({0, 1, 0}), z = t.vector({0, 0, 1}), o = t.point({0, 0, 0});
    const unsigned id = unsigned(top_.size() + instances_.size());
    instances_.push_back({{{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}, o, uint32_t(placement.group)});
    const std::array<float, 12> columns{x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, o.x, o.y, o.z};
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, group_scenes_[placement.group].get());
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
}

Vec3 Accelerator::Instance::point(const Vec3& p) const {
  return Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + translation;
}

float Accelerator::Instance::largest_stretch() const {
  float largest = 0;
  for (const Vec3& row : rows) largest = std::max(largest, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
  return largest;
}

Vec3 Accelerator::Instance::normal(const Vec3& n) const {
  const Vec3 c0 = cross(rows[1], rows[2]), c1 = cross(rows[2], rows[0]), c2 = cross(rows[0], rows[1]);
  const float sign = dot(rows[0], c0) < 0 ? -1.f : 1.f;
  return Vec3{dot(c0, n), dot(c1, n), dot(c2, n)} * sign;
}

bool Accelerator::closest(const Ray& ray, uint64_t key, RTCRayHit& query) const {
  embree::Query context(key);
  return closest(ray, context, query);
}

bool Accelerator::closest(const Ray& ray, embree::Query& context, RTCRayHit& query) const {
  query.ray = to_embree(ray);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(scene_.get(), query, context);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool Accelerator::intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const {
  RTCRayHit query;
  embree::Query context(key);
  if (!closest(ray, context, query)) return false;
  const bool instanced = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const Instance* instance = instanced ? &instances_[query.hit.instID[0] - top_.size()] : nullptr;
  const Primitive& primitive = (instanced ? groups_[instance->group] : top_)[query.hit.geomID];
  Hit& hit = point.hit;
  hit.extent = 0;
  Vec3 ns;
  if (const auto* mesh = std::get_if<MeshPtr>(&primitive.geometry)) {
    fill_triangle(**mesh, query.hit, hit, ns);
  } else {
    hit.ng = ns = {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
    hit.uv = {query.hit.u, query.hit.v};
    hit.p = context.p;
    hit.extent = largest_coordinate(hit.p);
  }
  if (instanced) {
    hit.p = instance->point(hit.p);
    hit.extent = instance->largest_stretch() * hit.extent + largest_coordinate(instance->translation);
    hit.ng = instance->normal(normalize_any(hit.ng));
    ns = instance->normal(normalize_any(ns));
  }
  set_frame(hit, hit.ng, ns, ray.d);
  point.material = primitive.material;
  point.light = primitive.light;
  point.material_id = primitive.material_id;
  point.instance_id = instanced ? uint32_t(query.hit.instID[0] - top_.size() + 1) : 0;
  return true;
}

bool Accelerator::occluded(const Ray& ray, uint64_t key) const {
  RTCRay query = to_embree(ray);
  embree::Query context(key);
  embree::occluded(scene_.get(), query, context);
  return query.tfar < 0;
}

Bounds Accelerator::bounds() const {
  RTCBounds b;
  rtcGetSceneBounds(scene_.get(), &b);
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

}  // namespace frond
