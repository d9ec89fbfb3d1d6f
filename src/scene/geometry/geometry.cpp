#include "scene/geometry/geometry.h"

#include <algorithm>
#include <array>

#include "scene/geometry/embree_surfaces.h"
#include "scene/geometry/geometry_object.h"
#include "scene/geometry/triangle.h"

namespace frond {
namespace {

/// Offset of spawned rays by offset_origin, as a share of the extent of a hit's coordinates.
constexpr float kLiftOfExtent = 0x1p-17f;

Vec3 face_forward(const Vec3& n, const Vec3& reference) { return dot(n, reference) < 0 ? -n : n; }

/// Sets the shading frame. Falls back to another direction if the surface is too small, or its vertex normals cancel,
/// so that there is no NaN.
void set_frame(Hit& hit, const Vec3* ns, const Vec3& direction) {
  const Vec3 geometric = normalize_any(hit.ng), shading = ns ? normalize_any(*ns) : geometric;
  hit.ng = geometric == Vec3{} ? -direction : geometric;
  hit.shading = Frame::around(shading == Vec3{} ? hit.ng : face_forward(shading, hit.ng));
}

/// Converts a packet to Embree's structure of arrays.
RTCRay8 from_packet(const RayPacket& packet) {
  RTCRay8 rays;
  for (size_t i = 0; i < RayPacket::kWidth; ++i) {
    const Ray& r = packet.rays[i];
    rays.org_x[i] = r.o.x, rays.org_y[i] = r.o.y, rays.org_z[i] = r.o.z;
    rays.dir_x[i] = r.d.x, rays.dir_y[i] = r.d.y, rays.dir_z[i] = r.d.z;
    rays.tfar[i] = r.t_max, rays.time[i] = r.time;
  }
  std::ranges::fill(rays.tnear, 0x1p-126f);  // a camera may lie in the plane of a surface that it does not see
  std::ranges::fill(rays.mask, ~0u);
  std::ranges::fill(rays.id, 0u);
  std::ranges::fill(rays.flags, 0u);
  return rays;
}

/// Embree's and our state of a packet's rays.
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

/// Fills a hit in the space of the containing object. Returns whether shading and geometric normal differ. `extent` is
/// the largest absolute value of each coordinate that entered the computation of the point.
bool fill(const Surface& surface, const RTCHit& at, const embree::Lane& lane, Hit& hit, Vec3& extent, Vec3& ns) {
  if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
    const Triangle t(**mesh, at.primID, {at.u, at.v});
    hit.p = t.p();
    extent = t.extent();
    hit.ng = t.ng();
    hit.at.uv = t.uv();
    if ((*mesh)->n.empty()) return false;
    ns = t.ns();
    return true;
  }
  hit.ng = {at.Ng_x, at.Ng_y, at.Ng_z};
  const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
  hit.at.uv = shape.uv(at.primID, {at.u, at.v});
  hit.p = lane.p;
  float largest = largest_coordinate(hit.p);
  extent = {largest, largest, largest};
  if (shape.is_plain()) return false;
  largest = std::max(largest, shape.clearance({lane.p, hit.ng, {at.u, at.v}, 0, at.primID}) / kLiftOfExtent);
  extent = {largest, largest, largest};
  ns = shape.shading_normal(at.primID, {at.u, at.v});
  return !(ns == Vec3{});
}

/// Returns derivatives of the surface at a hit, in the space of the containing object.
SurfaceDerivatives derivatives_of(const Surface& surface, const RTCHit& at, const embree::Lane& lane) {
  if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry))
    return Triangle(**mesh, at.primID, {at.u, at.v}).derivatives();
  return std::get<AnalyticShapePtr>(surface.geometry)
      ->derivatives({lane.p, {at.Ng_x, at.Ng_y, at.Ng_z}, {at.u, at.v}, 0, at.primID});
}

/// Returns the map with this inverse, in double precision, so that it agrees with the inverse, by which rays are
/// transformed, even where that is inaccurate.
AffineMap inverse_of(const AffineMap::Inverse& map) {
  const auto image = [](Float4 v) { return Vec3d{double(v[0]), double(v[1]), double(v[2])}; };
  const Vec3d x = image(map.x), y = image(map.y), z = image(map.z), yz = cross(y, z);
  const double scale = 1 / dot(x, yz);
  const auto row = [scale](const Vec3d& v, float translation) {
    return std::array{float(v.x * scale), float(v.y * scale), float(v.z * scale), translation};
  };
  const Float4& t = map.translation;
  return {{row(yz, t[0]), row(cross(z, x), t[1]), row(cross(x, y), t[2])}};
}

/// Returns the map of a row. If inverses are stored, it is computed from `inverse`, which the search has just read: to
/// read the table's row would wait for memory. Bounds, areas and sampled points follow the table's row, which differs
/// by about 1e-7 times the map's condition number.
AffineMap map_of(const GeometryInstances& set, uint32_t row, float time, const AffineMap::Inverse& inverse) {
  return set.inverses.empty() ? set.instances.map(row, time) : inverse_of(inverse);
}

/// Transforms derivatives from an object's space to the instance's. Normal derivatives scale with the normal.
void place(const AffineMap& map, const AffineMap::Inverse& inverse, SurfaceDerivatives& d) {
  d.dpdu = map.vector(d.dpdu), d.dpdv = map.vector(d.dpdv);
  d.dndu = inverse.normal_from_object(d.dndu), d.dndv = inverse.normal_from_object(d.dndv);
}

/// Sets the derivatives of a hit, and its frame along dpdu.
[[gnu::noinline]] void set_derivatives(const Surface& surface, const RTCHit& at, const embree::Lane& lane,
                                       uint32_t level, float time, Hit& hit) {
  SurfaceDerivatives d = derivatives_of(surface, at, lane);
  for (uint32_t i = level; i-- > 0;) {
    const auto& set = *static_cast<const GeometryInstances*>(lane.hit[i].set);
    const uint32_t row = lane.hit[i].row;
    AffineMap::Inverse made;
    const AffineMap::Inverse& inverse = set.inverse(row, time, made);
    place(map_of(set, row, time, inverse), inverse, d);
    if (set.instances.is_placed) place(set.instances.placement, set.from_placement, d);
  }
  hit.derivatives = d;
  hit.shading = Frame::along(hit.shading.z, d.dpdu);
}

/// Rescales a normal so that products with a map's entries neither overflow nor underflow.
Vec3 rescaled_normal(const Vec3& n) {
  const float square = dot(n, n);
  return square > 1e-16f && square < 1e16f ? n : normalize_any(n);
}

/// Transforms a hit from an object's space to the instance's. `ns` is nullptr if the hit has only its geometric normal.
void place(const AffineMap& map, const AffineMap::Inverse& inverse, Hit& hit, Vec3& extent, Vec3* ns) {
  hit.p = map.point(hit.p);
  extent = map.bound_point(extent);
  hit.ng = inverse.normal_from_object(rescaled_normal(hit.ng));
  if (ns) *ns = inverse.normal_from_object(rescaled_normal(*ns));
}

/// Component along the normal `ng`, a unit vector, of a bound of coordinates: errors within the surface's plane do not
/// bring a ray's origin to its other side. So a large horizontal plane can be close to another one.
float along_normal(const Vec3& extent, const Vec3& ng) {
  const Vec3 n{std::abs(ng.x), std::abs(ng.y), std::abs(ng.z)};
  return std::min(dot(n, extent), largest_coordinate(extent));
}

}  // namespace

Geometry::~Geometry() = default;

/// Merges columns of the same name from all tables.
std::vector<InstanceColumn> Geometry::columns() const {
  std::vector<InstanceColumn> all;
  const auto add = [&all](const GeometryObject& object) {
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

/// Embree's query, followed by the evaluation of the hit.
bool Geometry::intersect(const Ray& ray, uint64_t key, DetailedMaterials detailed, GeometryHit& met, Hit& hit) const {
  RTCRayHit query;
  embree::Lane lane;
  lane.key = key;
  embree::Query context(&lane);
  if (!closest(ray, context, query)) return false;
  met.t = query.ray.tfar;
  compute_hit(query.hit, lane, ray, detailed, met, hit);
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

uint32_t Geometry::intersect(const RayPacket& packet, DetailedMaterials detailed, GeometryHit* met,
                             SurfacePoint* points) const {
  PacketQuery context(packet);
  RTCRayHit8 query;
  const uint32_t hits = closest(packet, context.query, context.valid.data(), query);
  for (unsigned i = 0; i < RayPacket::kWidth; ++i)
    if (hits >> i & 1) {
      const RTCHit at = rtcGetHitFromHitN(reinterpret_cast<RTCHitN*>(&query.hit), RayPacket::kWidth, i);
      met[i].t = query.ray.tfar[i];
      compute_hit(at, context.lanes[i], packet.rays[i], detailed, met[i], points[i].hit);
    }
  return hits;
}

void Geometry::compute_hit(const RTCHit& at, const embree::Lane& lane, const Ray& ray, DetailedMaterials detailed,
                           GeometryHit& met, Hit& hit) const {
  const GeometryObject* object = world_.get();
  const uint32_t level = embree::level_of(at);
  hit.at.instance = {};
  met.instance = 0;
  for (uint32_t i = 0; i < level; ++i) {
    const auto& set = *static_cast<const GeometryInstances*>(lane.hit[i].set);
    const uint32_t row = lane.hit[i].row;
    const InstanceTable& table = *set.instances.table;
    object = &set.object(row);
    met.instance += set.ids.empty() ? set.first_id + row * object->ids : set.ids[row];
    if (!table.columns().empty()) hit.at.instance.add(table.columns(), table.bytes(row));
  }
  const Surface& surface = object->parts.surfaces[at.geomID];
  Vec3 extent, own_normal;
  Vec3* const ns = fill(surface, at, lane, hit, extent, own_normal) ? &own_normal : nullptr;
  for (uint32_t i = level; i-- > 0;) {
    const auto& set = *static_cast<const GeometryInstances*>(lane.hit[i].set);
    const uint32_t row = lane.hit[i].row;
    AffineMap::Inverse made;
    const AffineMap::Inverse& inverse = set.inverse(row, ray.time, made);
    place(map_of(set, row, ray.time, inverse), inverse, hit, extent, ns);
    if (set.instances.is_placed) place(set.instances.placement, set.from_placement, hit, extent, ns);
  }
  set_frame(hit, ns, ray.d);
  hit.extent = along_normal(extent, hit.ng);
  if (detailed.contains(surface.material)) set_derivatives(surface, at, lane, level, ray.time, hit);
  met.material = surface.material;
  met.medium_interface = surface.medium_interface;
  met.surface = level == 0 ? std::optional(at.geomID) : std::nullopt;
  met.primitive = at.primID;
  met.shape = &surface;
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

/// Embree sets tfar to minus infinity if the ray is occluded.
bool Geometry::occluded(const Ray& ray, uint64_t key) const {
  RTCRay query = embree::from_ray(ray);
  embree::Lane lane;
  lane.key = key;
  embree::Query context(&lane);
  embree::occluded(world_->scene.get(), query, context);
  return query.tfar < 0;
}

float Geometry::largest_ray_coordinate(float reach) const {
  // In an object's space a point is as far from any point of the object as the stretched distance in the world.
  float largest = 0;
  const auto add = [&](const GeometryObject& object) {
    if (!object.bounds.is_empty())
      largest = std::max({largest, largest_coordinate(object.bounds.min), largest_coordinate(object.bounds.max)});
  };
  for (const auto& object : objects_) add(*object);
  add(*world_);
  return largest + 2 * reach * world_->stretch;
}

bool Geometry::has_motion() const {
  const auto has = [](const GeometryObject& object) {
    return std::ranges::any_of(object.parts.instances, [](const Instances& i) { return !i.motions.empty(); });
  };
  return has(*world_) || std::ranges::any_of(objects_, [&has](const auto& object) { return has(*object); });
}

Bounds Geometry::bounds() const { return embree::bounds_of(world_->scene.get()); }

const std::vector<Surface>& Geometry::surfaces() const { return world_->parts.surfaces; }

uint64_t Geometry::instances() const { return world_->instances.empty() ? 0 : world_->ids - 1; }

}  // namespace frond
