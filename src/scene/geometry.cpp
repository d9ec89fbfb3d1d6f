#include "scene/geometry.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/error.h"
#include "scene/embree_surfaces.h"
#include "scene/triangle.h"

namespace frond {

/// Copies of objects, as their callbacks need them.
struct Geometry::Copies {
  const Instances& instances;
  std::vector<const Object*> objects;  ///< by row; a single one: the same for all
  uint64_t first_id = 0;               ///< of what the first row holds, in the object that these copies are part of
  std::vector<uint64_t> ids = {};      ///< by row, from first_id; empty: all rows hold as many

  const Object& object(size_t row) const { return *objects[objects.size() == 1 ? 0 : row]; }
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
void set_frame(Hit& hit, const Vec3& ng, const Vec3& ns, const Vec3& direction) {
  const Vec3 geometric = normalize_any(ng), shading = normalize_any(ns);
  hit.ng = geometric == Vec3{} ? -direction : geometric;
  hit.shading = Frame::around(shading == Vec3{} ? hit.ng : face_forward(shading, hit.ng));
}

/// By as much as rounding may have moved what lies within.
Bounds widened(const Bounds& b) {
  const float slack = 0x1p-20f * std::max(largest_coordinate(b.min), largest_coordinate(b.max));
  const Vec3 by{slack, slack, slack};
  return {b.min - by, b.max + by};
}

/// Whether a ray passes a box. Copies' boxes in the world are wider than those in their own space: most of the rays
/// that pass the one miss the other.
bool passes(const Ray& ray, const Bounds& box) {
  float enter = 0, leave = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / ray.d[axis];
    const float a = (box.min[axis] - ray.o[axis]) * inverse, b = (box.max[axis] - ray.o[axis]) * inverse;
    // NaN, where a ray runs along a face, leaves the bounds as they are.
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave * (1 + 0x1p-20f);
}

/// In the space of the object that the surface is part of.
void fill(const Surface& surface, const RTCHit& at, const embree::Query& query, Hit& hit, Vec3& ns) {
  hit.extent = 0;
  if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
    const Triangle t(**mesh, at.primID, {at.u, at.v});
    hit.p = t.p();
    for (const uint32_t i : t.corners()) hit.extent = std::max(hit.extent, largest_coordinate((*mesh)->p[i]));
    hit.ng = t.ng();
    ns = t.ns();
    hit.at.uv = t.uv();
  } else {
    hit.ng = ns = {at.Ng_x, at.Ng_y, at.Ng_z};
    hit.at.uv = {at.u, at.v};
    hit.p = query.p;
    hit.extent = largest_coordinate(hit.p);
  }
}

/// Out of an object into the space where a copy of it stands.
void place(const AffineMap& map, Hit& hit, Vec3& ns) {
  hit.p = map.point(hit.p);
  hit.extent = map.largest_stretch() * hit.extent + largest_coordinate(map.translation());
  hit.ng = map.normal(normalize_any(hit.ng));
  ns = map.normal(normalize_any(ns));
}

}  // namespace

/// What Embree asks of copies of objects: the ray is taken into the object's space, and the search goes on there.
struct GeometryCallbacks {
  using Copies = Geometry::Copies;
  using Object = Geometry::Object;

  static Ray to_object(const Copies& copies, uint32_t row, const Ray& ray) {
    const Instances& i = copies.instances;
    return i.table->map(row).to_object(i.is_placed ? i.placement.to_object(ray) : ray);
  }

  static void intersect(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const auto& copies = *static_cast<const Copies*>(args->geometryUserPtr);
    auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    auto& query = *reinterpret_cast<embree::Query*>(args->context);
    const Object& object = copies.object(args->primID);
    const Ray inner = to_object(copies, args->primID, embree::to_ray(ray.ray));
    if (!passes(inner, object.bounds)) return;
    const uint32_t level = query.depth;
    const embree::Query::Copy copy{&copies, args->primID};
    query.enter(copy);
    if (object.only_primitive) {
      constexpr embree::Target kOnly{0, 0};
      if (const auto point = embree::meet(*object.only_primitive, kOnly, inner, query)) {
        embree::report(*point, kOnly, ray, query);
        query.hit[level] = copy;
      }
    } else {
      RTCRayHit nested;
      nested.ray = embree::from_ray(inner);
      nested.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      embree::intersect(object.scene.get(), nested, query);
      if (nested.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        ray.ray.tfar = nested.ray.tfar;
        ray.hit = nested.hit;
        query.hit[level] = copy;
      }
    }
    query.leave();
  }

  static void occluded(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const auto& copies = *static_cast<const Copies*>(args->geometryUserPtr);
    auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
    auto& query = *reinterpret_cast<embree::Query*>(args->context);
    const Object& object = copies.object(args->primID);
    const Ray inner = to_object(copies, args->primID, embree::to_ray(ray));
    if (!passes(inner, object.bounds)) return;
    query.enter({&copies, args->primID});
    if (object.only_primitive) {
      if (embree::meet(*object.only_primitive, {0, 0}, inner, query)) ray.tfar = -INFINITY;
    } else {
      RTCRay nested = embree::from_ray(inner);
      embree::occluded(object.scene.get(), nested, query);
      if (nested.tfar < 0) ray.tfar = -INFINITY;
    }
    query.leave();
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
  embree::Query context(key);
  return closest(ray, context, query);
}

bool Geometry::closest(const Ray& ray, embree::Query& context, RTCRayHit& query) const {
  query.ray = embree::from_ray(ray);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(world_->scene.get(), query, context);
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

bool Geometry::intersect(const Ray& ray, uint64_t key, GeometryHit& hit) const {
  RTCRayHit query;
  embree::Query context(key);
  if (!closest(ray, context, query)) return false;
  const Object* object = world_.get();
  const uint32_t level = embree::level_of(query.hit);
  hit.hit.at.instance = {};
  hit.instance = 0;
  for (uint32_t i = 0; i < level; ++i) {
    const auto& copies = *static_cast<const Copies*>(context.hit[i].copies);
    const uint32_t row = context.hit[i].row;
    const InstanceTable& table = *copies.instances.table;
    object = &copies.object(row);
    hit.instance += copies.ids.empty() ? copies.first_id + row * object->ids : copies.ids[row];
    if (!table.columns().empty()) hit.hit.at.instance.add(table.columns(), table.bytes(row));
  }
  const Surface& surface = object->parts.surfaces[query.hit.geomID];
  Vec3 ns;
  fill(surface, query.hit, context, hit.hit, ns);
  for (uint32_t i = level; i-- > 0;) {
    const Instances& instances = static_cast<const Copies*>(context.hit[i].copies)->instances;
    place(instances.table->map(context.hit[i].row), hit.hit, ns);
    if (instances.is_placed) place(instances.placement, hit.hit, ns);
  }
  set_frame(hit.hit, hit.hit.ng, ns, ray.d);
  hit.t = query.ray.tfar;
  hit.material = surface.material;
  hit.surface = level == 0 ? std::optional(query.hit.geomID) : std::nullopt;
  return true;
}

bool Geometry::occluded(const Ray& ray, uint64_t key) const {
  RTCRay query = embree::from_ray(ray);
  embree::Query context(key);
  embree::occluded(world_->scene.get(), query, context);
  return query.tfar < 0;
}

Bounds Geometry::bounds() const { return bounds_of(world_->scene.get()); }

const std::vector<Surface>& Geometry::surfaces() const { return world_->parts.surfaces; }

uint64_t Geometry::instances() const { return world_->copies.empty() ? 0 : world_->ids - 1; }

}  // namespace frond
