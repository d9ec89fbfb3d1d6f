#include "scene/geometry.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "core/error.h"
#include "scene/embree_surfaces.h"
#include "scene/triangle.h"

namespace frond {

/// Copies of objects, as their callbacks need them.
struct Geometry::Copies {
  /// Inverse maps are kept of so many copies at most: 64 MB.
  static constexpr size_t kMostKept = 1 << 20;

  const Instances& instances;
  std::vector<const Object*> objects;  ///< by row; a single one: the same for all
  uint64_t first_id = 0;               ///< of what the first row holds, in the object that these copies are part of
  std::vector<uint64_t> ids = {};      ///< by row, from first_id; empty: all rows hold as many

  std::vector<AffineMap::Inverse> inverses = {};  ///< of the table's maps; empty: they are made when they are needed
  AffineMap::Inverse from_placement = {};         ///< where there is one

  const Object& object(size_t row) const { return *objects[objects.size() == 1 ? 0 : row]; }
  /// `made`: where it is put if it is not kept.
  const AffineMap::Inverse& inverse(size_t row, AffineMap::Inverse& made) const {
    return inverses.empty() ? made = instances.table->map(row).inverse() : inverses[row];
  }
};

struct Geometry::Object {
  ObjectParts parts;
  std::vector<Copies> copies = {};
  embree::Scene scene = {};
  Bounds bounds = {};              ///< a little wider than it is
  std::vector<Vec3> outline = {};  ///< it lies within the hull of these points
  /// How many ids a copy of it takes: one for each copy in it that holds no others, and one for its own surfaces.
  uint64_t ids = 1;
  uint32_t depth = 0;  ///< of copies in it
  /// All that it is, where that is one analytic primitive: then nothing has to be traversed.
  const Surface* only_primitive = nullptr;
};

namespace {

float largest_coordinate(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The convex hull of some points of a plane, by its lower and its upper chain (Andrew 1979).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](const Vec2& p) { return std::pair(p.x, p.y); });
  std::vector<Vec2> hull;
  const auto add_chain = [&hull](const auto& chain) {
    const size_t start = hull.size();
    for (const Vec2& p : chain) {
      const auto turns_in = [&] {
        const Vec2 a = hull[hull.size() - 1] - hull[hull.size() - 2], b = p - hull.back();
        return double(a.x) * double(b.y) - double(a.y) * double(b.x) <= 0;
      };
      while (hull.size() >= start + 2 && turns_in()) hull.pop_back();
      hull.push_back(p);
    }
  };
  add_chain(points);
  std::ranges::reverse(points);
  add_chain(points);
  return hull;
}

/// Few points whose hull holds all of these: a prism along the axis on which they reach least far. Leaves are flat.
std::vector<Vec3> few_around(const std::vector<Vec3>& points, const Bounds& bounds) {
  constexpr size_t kFew = 16;
  if (points.size() <= kFew) return points;
  const Vec3 size = bounds.max - bounds.min;
  const int z = size.z <= size.x && size.z <= size.y ? 2 : size.y <= size.x ? 1 : 0, x = (z + 1) % 3, y = (z + 2) % 3;
  std::vector<Vec2> flat;
  for (const Vec3& p : points) flat.push_back({p[x], p[y]});
  std::vector<Vec3> around;
  for (const Vec2& corner : convex_hull(std::move(flat)))
    for (const float height : {bounds.min[z], bounds.max[z]}) {
      std::array<float, 3> p{};
      p[size_t(x)] = corner.x, p[size_t(y)] = corner.y, p[size_t(z)] = height;
      around.push_back({p[0], p[1], p[2]});
    }
  return around;
}

/// Points around an object: the tighter they are, the fewer of its copies a ray has to look into.
std::vector<Vec3> outline_of(const ObjectParts& parts, const Bounds& bounds) {
  if (!parts.instances.empty()) return bounds.corners();
  std::vector<Vec3> points;
  for (const Surface& s : parts.surfaces) {
    if (const auto* mesh = std::get_if<MeshPtr>(&s.geometry)) {
      points.insert(points.end(), (*mesh)->p.begin(), (*mesh)->p.end());
    } else {
      const AnalyticShape& shape = *std::get<AnalyticShapePtr>(s.geometry);
      for (unsigned i = 0; i < shape.count(); ++i)
        for (const Vec3& p : shape.outline(i)) points.push_back(p);
    }
  }
  return few_around(points, bounds);
}

Bounds bounds_of(RTCScene scene) {
  RTCBounds b;
  rtcGetSceneBounds(scene, &b);
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

Vec3 face_forward(const Vec3& n, const Vec3& reference) { return dot(n, reference) < 0 ? -n : n; }

/// Where the surface is so small, or its vertex normals so contrary, that there is no normal, the next best: no NaN.
void set_frame(Hit& hit, const Vec3* ns, const Vec3& direction) {
  const Vec3 geometric = normalize_any(hit.ng), shading = ns ? normalize_any(*ns) : geometric;
  hit.ng = geometric == Vec3{} ? -direction : geometric;
  hit.shading = Frame::around(shading == Vec3{} ? hit.ng : face_forward(shading, hit.ng));
}

/// By as much as rounding may have moved what lies within.
Bounds widened(const Bounds& b) {
  const float slack = 0x1p-20f * std::max(largest_coordinate(b.min), largest_coordinate(b.max));
  const Vec3 by{slack, slack, slack};
  return {b.min - by, b.max + by};
}

Float4 to_float4(const Vec3& v) { return Float4{v.x, v.y, v.z, 0}; }

/// Whether a ray passes a box. Copies' boxes in the world are wider than those in their own space: most of the rays
/// that pass the one miss the other.
bool passes(Float4 origin, Float4 direction, float t_max, const Bounds& box) {
  const Float4 inverse = 1 / direction;
  const Float4 a = (to_float4(box.min) - origin) * inverse, b = (to_float4(box.max) - origin) * inverse;
  // NaN, where a ray runs along a face, leaves the bounds as they are.
  const Float4 near = b < a ? b : a, far = a < b ? b : a;
  const Float4 start{}, end = start + t_max;
  const Float4 enter = start < near ? near : start, leave = far < end ? far : end;
  return std::max({enter[0], enter[1], enter[2]}) <= std::min({leave[0], leave[1], leave[2]}) * (1 + 0x1p-20f);
}

using Float8 = float __attribute__((vector_size(32), may_alias));

Float8& lanes(float* x) { return *reinterpret_cast<Float8*>(x); }
const Float8& lanes(const float* x) { return *reinterpret_cast<const Float8*>(x); }

/// Both may be the same rays.
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

/// As `passes` of one ray. Whether any does.
bool passes(const RTCRay8& rays, const Bounds& box, const int* valid, int* passing) {
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

RTCRay8 from_packet(const RayPacket& packet) {
  RTCRay8 rays;
  for (size_t i = 0; i < RayPacket::kWidth; ++i) {
    const Ray& r = packet.rays[i];
    rays.org_x[i] = r.o.x, rays.org_y[i] = r.o.y, rays.org_z[i] = r.o.z;
    rays.dir_x[i] = r.d.x, rays.dir_y[i] = r.d.y, rays.dir_z[i] = r.d.z;
    rays.tfar[i] = r.t_max;
  }
  std::ranges::fill(rays.tnear, 0.f);
  std::ranges::fill(rays.time, 0.f);
  std::ranges::fill(rays.mask, ~0u);
  std::ranges::fill(rays.id, 0u);
  std::ranges::fill(rays.flags, 0u);
  return rays;
}

/// What Embree, and we, know of a packet's rays.
struct PacketQuery {
  alignas(32) std::array<int, RayPacket::kWidth> valid;
  std::array<embree::Lane, RayPacket::kWidth> lanes;
  embree::Query query{lanes.data()};

  explicit PacketQuery(const RayPacket& packet) {
    for (size_t i = 0; i < RayPacket::kWidth; ++i) {
      valid[i] = -int(packet.lanes >> i & 1);
      lanes[i].key = packet.keys[i];
    }
  }
};

/// In the space of the object that the surface is part of. Whether the shading normal is not the geometric one.
bool fill(const Surface& surface, const RTCHit& at, const embree::Lane& lane, Hit& hit, Vec3& ns) {
  hit.extent = 0;
  if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
    const Triangle t(**mesh, at.primID, {at.u, at.v});
    hit.p = t.p();
    for (const uint32_t i : t.corners()) hit.extent = std::max(hit.extent, largest_coordinate((*mesh)->p[i]));
    hit.ng = t.ng();
    hit.at.uv = t.uv();
    if ((*mesh)->n.empty()) return false;
    ns = t.ns();
    return true;
  }
  hit.ng = {at.Ng_x, at.Ng_y, at.Ng_z};
  hit.at.uv = {at.u, at.v};
  hit.p = lane.p;
  hit.extent = largest_coordinate(hit.p);
  return false;
}

/// A normal that a map may be applied to: no product of it overflows or vanishes.
Vec3 of_moderate_length(const Vec3& n) {
  const float square = dot(n, n);
  return square > 1e-16f && square < 1e16f ? n : normalize_any(n);
}

/// Out of an object into the space where a copy of it stands. `ns` is nullptr where it is that of the hit.
void place(const AffineMap& map, const AffineMap::Inverse& inverse, Hit& hit, Vec3* ns) {
  hit.p = map.point(hit.p);
  hit.extent = map.largest_stretch() * hit.extent + largest_coordinate(map.translation());
  hit.ng = inverse.normal_out(of_moderate_length(hit.ng));
  if (ns) *ns = inverse.normal_out(of_moderate_length(*ns));
}

}  // namespace

/// What Embree asks of copies of objects: the ray is taken into the object's space, and the search goes on there.
struct GeometryCallbacks {
  using Copies = Geometry::Copies;
  using Object = Geometry::Object;

  /// False where the ray misses the object's box.
  static bool to_object(const embree::Copy& copy, const RTCRay& ray, RTCRay& inner) {
    const Copies& copies = *static_cast<const Copies*>(copy.copies);
    Float4 origin = embree::origin(ray), direction = embree::direction(ray);
    if (copies.instances.is_placed) {
      origin = copies.from_placement.point(origin);
      direction = copies.from_placement.vector(direction);
    }
    AffineMap::Inverse made;
    const AffineMap::Inverse& map = copies.inverse(copy.row, made);
    inner = embree::from_vectors(map.point(origin), map.vector(direction), ray.tfar);
    return passes(embree::origin(inner), embree::direction(inner), ray.tfar, copies.object(copy.row).bounds);
  }

  static void intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& copies = *static_cast<const Copies*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<embree::Query*>(args->context);
    const embree::Copy copy{&copies, args->primID};
    if (args->N == RayPacket::kWidth) {
      intersect(copy, args->valid, *reinterpret_cast<RTCRayHit8*>(args->rayhit), query);
    } else if (args->valid[0]) {
      intersect(copy, *reinterpret_cast<RTCRayHit*>(args->rayhit), query);
    }
  }

  static void occluded(const RTCOccludedFunctionNArguments* args) {
    const auto& copies = *static_cast<const Copies*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<embree::Query*>(args->context);
    const embree::Copy copy{&copies, args->primID};
    if (args->N == RayPacket::kWidth) {
      occluded(copy, args->valid, *reinterpret_cast<RTCRay8*>(args->ray), query);
    } else if (args->valid[0]) {
      occluded(copy, *reinterpret_cast<RTCRay*>(args->ray), query);
    }
  }

  static void intersect(const embree::Copy& copy, RTCRayHit& ray, embree::Query& query) {
    const auto& copies = *static_cast<const Copies*>(copy.copies);
    RTCRayHit nested;
    if (!to_object(copy, ray.ray, nested.ray)) return;
    const Object& object = copies.object(copy.row);
    const uint32_t level = query.depth;
    query.enter(copy);
    if (object.only_primitive) {
      constexpr embree::Target kOnly{0, 0};
      const Ray inner = embree::to_ray(nested.ray);
      if (const auto point = embree::meet(*object.only_primitive, kOnly, inner, query, *query.lane)) {
        embree::report(*point, kOnly, reinterpret_cast<RTCRayHitN*>(&ray), 1, 0, query);
        query.lane->hit[level] = copy;
      }
    } else {
      nested.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      embree::intersect(object.scene.get(), nested, query);
      if (nested.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        ray.ray.tfar = nested.ray.tfar;
        ray.hit = nested.hit;
        query.lane->hit[level] = copy;
      }
    }
    query.leave();
  }

  static void occluded(const embree::Copy& copy, RTCRay& ray, embree::Query& query) {
    const auto& copies = *static_cast<const Copies*>(copy.copies);
    RTCRay nested;
    if (!to_object(copy, ray, nested)) return;
    const Object& object = copies.object(copy.row);
    query.enter(copy);
    if (object.only_primitive) {
      if (embree::meet(*object.only_primitive, {0, 0}, embree::to_ray(nested), query, *query.lane))
        ray.tfar = -INFINITY;
    } else {
      embree::occluded(object.scene.get(), nested, query);
      if (nested.tfar < 0) ray.tfar = -INFINITY;
    }
    query.leave();
  }

  /// The rays of a packet in the object's space, and which of them pass its box. False where none does.
  static bool to_object(const embree::Copy& copy, const int* valid, const RTCRay8& rays, RTCRay8& inner, int* passing) {
    const Copies& copies = *static_cast<const Copies*>(copy.copies);
    AffineMap::Inverse made;
    const AffineMap::Inverse& map = copies.inverse(copy.row, made);
    if (copies.instances.is_placed) {
      transform(copies.from_placement, rays, inner);
      transform(map, inner, inner);
    } else {
      transform(map, rays, inner);
    }
    return passes(inner, copies.object(copy.row).bounds, valid, passing);
  }

  static void intersect(const embree::Copy& copy, const int* valid, RTCRayHit8& rays, embree::Query& query) {
    RTCRayHit8 inner;
    alignas(32) std::array<int, RayPacket::kWidth> passing;
    if (!to_object(copy, valid, rays.ray, inner.ray, passing.data())) return;
    std::ranges::fill(inner.hit.geomID, RTC_INVALID_GEOMETRY_ID);
    const uint32_t level = query.depth;
    query.enter(copy);
    embree::intersect(passing.data(), static_cast<const Copies*>(copy.copies)->object(copy.row).scene.get(), inner,
                      query);
    query.leave();
    for (unsigned i = 0; i < RayPacket::kWidth; ++i) {
      if (!passing[i] || inner.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      rays.ray.tfar[i] = inner.ray.tfar[i];
      const RTCHit at = rtcGetHitFromHitN(reinterpret_cast<RTCHitN*>(&inner.hit), RayPacket::kWidth, i);
      rtcCopyHitToHitN(reinterpret_cast<RTCHitN*>(&rays.hit), &at, RayPacket::kWidth, i);
      query.lane[i].hit[level] = copy;
    }
  }

  static void occluded(const embree::Copy& copy, const int* valid, RTCRay8& rays, embree::Query& query) {
    RTCRay8 inner;
    alignas(32) std::array<int, RayPacket::kWidth> passing;
    if (!to_object(copy, valid, rays, inner, passing.data())) return;
    query.enter(copy);
    embree::occluded(passing.data(), static_cast<const Copies*>(copy.copies)->object(copy.row).scene.get(), inner,
                     query);
    query.leave();
    for (unsigned i = 0; i < RayPacket::kWidth; ++i)
      if (passing[i] && inner.tfar[i] < 0) rays.tfar[i] = -INFINITY;
  }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& copies = *static_cast<const Copies*>(args->geometryUserPtr);
    const Instances& i = copies.instances;
    const AffineMap map = i.table->map(args->primID);
    Bounds b;
    for (const Vec3& corner : copies.object(args->primID).outline) {
      const Vec3 p = map.point(corner);
      b.add(i.is_placed ? i.placement.point(p) : p);
    }
    b = widened(b);  // points are rounded on their way out, rays on their way in
    *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
  }

  static RTCGeometry new_geometry(RTCDevice device, const Copies& copies) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(copies.instances.table->size()));
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    rtcSetGeometryUserData(geometry, const_cast<Copies*>(&copies));
    rtcCommitGeometry(geometry);
    return geometry;
  }
};

void embree::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void embree::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

Geometry::Geometry(std::vector<ObjectParts> objects, ObjectParts world, int threads) {
  // AVX-512 gains nothing for single rays, and changes the last bits of hits.
  device_.reset(rtcNewDevice(fmt::format("max_isa=avx2,threads={}", threads).c_str()));
  if (!device_) fail({}, "Embree cannot start: error {}", int(rtcGetDeviceError(nullptr)));
  for (ObjectParts& parts : objects) {
    const uint64_t first_id = parts.surfaces.empty() ? 0 : 1;
    objects_.push_back(build(std::move(parts), first_id));
  }
  world_ = build(std::move(world), 1);
  if (world_->depth > InstanceRows::kMost)
    fail({}, "copies of objects are nested {} deep: {} is the limit", world_->depth, InstanceRows::kMost);
}

Geometry::~Geometry() = default;

void Geometry::check() const {
  if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
    fail({}, "Embree cannot build the scene: {}",
         error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", int(error)));
}

std::unique_ptr<Geometry::Object> Geometry::build(ObjectParts parts, uint64_t first_id) {
  auto object = std::make_unique<Object>(Object{.parts = std::move(parts)});
  if (!object->parts.instances.empty()) object->ids = first_id;
  object->scene.reset(rtcNewScene(device_.get()));
  RTCScene scene = object->scene.get();
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips between triangles
  attach(*object);
  rtcCommitScene(scene);
  check();
  object->bounds = widened(bounds_of(scene));
  object->outline = outline_of(object->parts, bounds_of(scene));
  const auto& surfaces = object->parts.surfaces;
  if (object->copies.empty() && surfaces.size() == 1)
    if (const auto* shape = std::get_if<AnalyticShapePtr>(&surfaces[0].geometry); shape && (*shape)->count() == 1)
      object->only_primitive = &surfaces[0];
  return object;
}

void Geometry::attach(Object& object) {
  unsigned id = 0;
  const auto add = [&](RTCGeometry geometry) {
    rtcAttachGeometryByID(object.scene.get(), geometry, id++);
    rtcReleaseGeometry(geometry);
  };
  for (const Surface& surface : object.parts.surfaces) add(embree::new_geometry(device_.get(), surface));
  if (object.parts.instances.empty()) return;
  for (const Instances& instances : object.parts.instances) {
    Copies copies{.instances = instances, .objects = {}, .first_id = object.ids};
    for (const uint32_t place : instances.objects) copies.objects.push_back(objects_[place].get());
    const size_t rows = instances.table->size();
    if (rows <= Copies::kMostKept)
      for (size_t row = 0; row < rows; ++row) copies.inverses.push_back(instances.table->map(row).inverse());
    if (instances.is_placed) copies.from_placement = instances.placement.inverse();
    const auto as_many = [&](const Object* o) { return o->ids == copies.objects.front()->ids; };
    if (rows == 0 || std::ranges::all_of(copies.objects, as_many)) {
      object.ids += rows == 0 ? 0 : rows * copies.objects.front()->ids;
    } else {
      for (size_t row = 0; row < rows; ++row) {
        copies.ids.push_back(object.ids);
        object.ids += copies.object(row).ids;
      }
    }
    for (const Object* o : copies.objects) object.depth = std::max(object.depth, o->depth + 1);
    object.copies.push_back(std::move(copies));
  }
  for (const Copies& copies : object.copies) add(GeometryCallbacks::new_geometry(device_.get(), copies));
}

/// Goes through all copies, and those in them.
class Geometry::Areas {
 public:
  explicit Areas(std::vector<float>& areas) : areas_(areas) {}

  /// `first`: the number of the object's own surfaces; those of copies in it count from there.
  void visit(const Object& object, const Transform& to_world, uint64_t first) {
    if (first > 0)
      for (const Surface& s : object.parts.surfaces) areas_[first - 1] += float(area(s, to_world));
    for (const Copies& copies : object.copies) {
      const Instances& set = copies.instances;
      const Transform placed = set.is_placed ? to_world * transform_of(set.placement) : to_world;
      for (size_t row = 0; row < set.table->size(); ++row) {
        const Object& copied = copies.object(row);
        const uint64_t id = copies.ids.empty() ? copies.first_id + row * copied.ids : copies.ids[row];
        visit(copied, placed * transform_of(set.table->map(row)), first + id);
      }
    }
  }

 private:
  static Transform transform_of(const AffineMap& map) {
    Transform::RowsDouble rows;
    for (size_t i = 0; i < 3; ++i) std::ranges::copy(map.rows[i], rows[i].begin());
    return Transform(rows);
  }

  /// Of a similar image the area is that of the surface times a factor.
  double area(const Surface& surface, const Transform& t) {
    const Vec3 x = t.vector({1, 0, 0}), y = t.vector({0, 1, 0}), z = t.vector({0, 0, 1});
    const float xx = dot(x, x), slack = 1e-4f * xx;
    const auto near = [slack](float a, float b) { return std::abs(a - b) <= slack; };
    if (near(dot(y, y), xx) && near(dot(z, z), xx) && near(dot(x, y), 0) && near(dot(y, z), 0) && near(dot(z, x), 0)) {
      const auto [known, is_new] = own_.try_emplace(&surface, 0);
      if (is_new) known->second = area_under(surface, Transform());
      return known->second * double(xx);
    }
    return area_under(surface, t);
  }

  static double area_under(const Surface& surface, const Transform& t) {
    double sum = 0;
    if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
      for (const auto& [a, b, c] : (*mesh)->triangles) {
        const auto& p = (*mesh)->p;
        sum += double(length(cross(t.vector(p[b] - p[a]), t.vector(p[c] - p[a])))) / 2;
      }
      return sum;
    }
    // By how much the map stretches the surface, on average over its points: exact where it is flat.
    constexpr int kPoints = 64;
    const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
    const AffineMap map{t.rows()};
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 n = shape.sample({(float(i) + 0.5f) / kPoints, float((i * 37) % kPoints) / kPoints}).ng;
      sum += double(length(map.normal(n))) / kPoints;
    }
    return sum * shape.area();
  }

  std::vector<float>& areas_;
  std::map<const Surface*, double> own_;
};

std::vector<InstanceColumn> Geometry::columns() const {
  std::vector<InstanceColumn> all;
  const auto add = [&all](const Object& object) {
    for (const Instances& set : object.parts.instances)
      for (const InstanceColumn& c : set.table->columns()) {
        const auto known = std::ranges::find(all, c.name, &InstanceColumn::name);
        if (known == all.end())
          all.push_back(c);
        else
          known->range = {std::min(known->range.min, c.range.min), std::max(known->range.max, c.range.max)};
      }
  };
  for (const auto& object : objects_) add(*object);
  add(*world_);
  return all;
}

std::vector<float> Geometry::areas() const {
  std::vector<float> areas(instances());
  Areas(areas).visit(*world_, Transform(), 0);
  return areas;
}

bool Geometry::closest(const Ray& ray, uint64_t key, RTCRayHit& query) const {
  embree::Lane lane;
  lane.key = key;
  embree::Query context(&lane);
  return closest(ray, context, query);
}

bool Geometry::closest(const Ray& ray, embree::Query& context, RTCRayHit& query) const {
  query.ray = embree::from_ray(ray);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(world_->scene.get(), query, context);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool Geometry::intersect(const Ray& ray, uint64_t key, GeometryHit& met, Hit& hit) const {
  RTCRayHit query;
  embree::Lane lane;
  lane.key = key;
  embree::Query context(&lane);
  if (!closest(ray, context, query)) return false;
  met.t = query.ray.tfar;
  describe(query.hit, lane, ray, met, hit);
  return true;
}

uint32_t Geometry::closest(const RayPacket& packet, embree::Query& context, const int* valid, RTCRayHit8& query) const {
  query.ray = from_packet(packet);
  std::ranges::fill(query.hit.geomID, RTC_INVALID_GEOMETRY_ID);
  std::ranges::fill(query.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
  embree::intersect(valid, world_->scene.get(), query, context);
  uint32_t hits = 0;
  for (size_t i = 0; i < RayPacket::kWidth; ++i)
    if (valid[i] && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) hits |= 1u << i;
  return hits;
}

uint32_t Geometry::closest(const RayPacket& packet, RTCRayHit8& query) const {
  PacketQuery context(packet);
  return closest(packet, context.query, context.valid.data(), query);
}

uint32_t Geometry::intersect(const RayPacket& packet, GeometryHit* met, SurfacePoint* points) const {
  PacketQuery context(packet);
  RTCRayHit8 query;
  const uint32_t hits = closest(packet, context.query, context.valid.data(), query);
  for (unsigned i = 0; i < RayPacket::kWidth; ++i)
    if (hits >> i & 1) {
      const RTCHit at = rtcGetHitFromHitN(reinterpret_cast<RTCHitN*>(&query.hit), RayPacket::kWidth, i);
      met[i].t = query.ray.tfar[i];
      describe(at, context.lanes[i], packet.rays[i], met[i], points[i].hit);
    }
  return hits;
}

void Geometry::describe(const RTCHit& at, const embree::Lane& lane, const Ray& ray, GeometryHit& met, Hit& hit) const {
  const Object* object = world_.get();
  const uint32_t level = embree::level_of(at);
  hit.at.instance = {};
  met.instance = 0;
  for (uint32_t i = 0; i < level; ++i) {
    const auto& copies = *static_cast<const Copies*>(lane.hit[i].copies);
    const uint32_t row = lane.hit[i].row;
    const InstanceTable& table = *copies.instances.table;
    object = &copies.object(row);
    met.instance += copies.ids.empty() ? copies.first_id + row * object->ids : copies.ids[row];
    if (!table.columns().empty()) hit.at.instance.add(table.columns(), table.bytes(row));
  }
  const Surface& surface = object->parts.surfaces[at.geomID];
  Vec3 own_normal;
  Vec3* const ns = fill(surface, at, lane, hit, own_normal) ? &own_normal : nullptr;
  for (uint32_t i = level; i-- > 0;) {
    const auto& copies = *static_cast<const Copies*>(lane.hit[i].copies);
    const uint32_t row = lane.hit[i].row;
    AffineMap::Inverse made;
    place(copies.instances.table->map(row), copies.inverse(row, made), hit, ns);
    if (copies.instances.is_placed) place(copies.instances.placement, copies.from_placement, hit, ns);
  }
  set_frame(hit, ns, ray.d);
  met.material = surface.material;
  met.surface = level == 0 ? std::optional(at.geomID) : std::nullopt;
}

uint32_t Geometry::occluded(const RayPacket& packet) const {
  PacketQuery context(packet);
  RTCRay8 query = from_packet(packet);
  embree::occluded(context.valid.data(), world_->scene.get(), query, context.query);
  uint32_t hits = 0;
  for (size_t i = 0; i < RayPacket::kWidth; ++i)
    if (context.valid[i] && query.tfar[i] < 0) hits |= 1u << i;
  return hits;
}

bool Geometry::occluded(const Ray& ray, uint64_t key) const {
  RTCRay query = embree::from_ray(ray);
  embree::Lane lane;
  lane.key = key;
  embree::Query context(&lane);
  embree::occluded(world_->scene.get(), query, context);
  return query.tfar < 0;
}

Bounds Geometry::bounds() const { return bounds_of(world_->scene.get()); }

const std::vector<Surface>& Geometry::surfaces() const { return world_->parts.surfaces; }

uint64_t Geometry::instances() const { return world_->copies.empty() ? 0 : world_->ids - 1; }

}  // namespace frond
