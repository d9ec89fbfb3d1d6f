#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/math/motion.h"
#include "core/shape.h"
#include "core/world.h"
#include "scene/geometry/instance_table.h"

// Forward declarations, so that this header does not require Embree.
struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCRayHit;
struct RTCRayHit8;
struct RTCHit;

namespace frond {

namespace embree {
struct Lane;
struct Query;
/// Deleter for Embree's reference-counted objects.
struct Release {
  void operator()(RTCDeviceTy* device) const;
  void operator()(RTCSceneTy* scene) const;
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;
}  // namespace embree

/// A shape with indices of its material and area light in the scene's description.
struct Surface {
  ShapeGeometry geometry;
  uint32_t material = 0;                      ///< index in the scene's description
  std::optional<uint32_t> area_light = {};    ///< index in the scene's description
  std::shared_ptr<const FloatTexture> alpha;  ///< null: opaque
  uint32_t medium_interface = 0;              ///< as in SurfacePoint
};

/// Instances of objects, one for each row of the table.
struct Instances {
  std::shared_ptr<const InstanceTable> table = {};
  std::vector<uint32_t> objects = {};  ///< object index by row; a single element applies to all rows
  AffineMap placement = {};            ///< transform of the whole table
  bool is_placed = false;              ///< false: `placement` is the identity
  std::vector<Motion> motions = {};    ///< by row, instead of the table's maps; empty: nothing moves

  AffineMap map(size_t row, float time) const {
    if (!motions.empty()) [[unlikely]]
      return motions[row].at(time);
    return table->map(row);
  }
};

/// Content of an object or of the world: surfaces, and instances of other objects.
struct ObjectParts {
  std::vector<Surface> surfaces;
  std::vector<Instances> instances;
  std::string name = {};  ///< of ObjectBegin; empty: the world, or a moving shape
};

/// A hit as indices, which the scene resolves.
struct GeometryHit {
  float t = 0;                      ///< along the ray
  uint32_t material = 0;            ///< as in Surface
  std::optional<uint32_t> surface;  ///< index in Geometry::surfaces; empty for instances
  uint32_t primitive = 0;           ///< index within the surface
  uint32_t medium_interface = 0;    ///< as in SurfacePoint
  uint64_t instance = 0;            ///< number of the instance, from 1; 0: the surface is not part of an object
  const Surface* shape = nullptr;   ///< the surface, of the world or of the instance's object
};

struct GeometryObject;

/// Flags of materials, by index, whose hits need derivatives; nullptr: none.
struct DetailedMaterials {
  const uint8_t* flags = nullptr;
  bool contains(uint32_t material) const { return flags && flags[material] != 0; }
};

/// Ray queries over surfaces and instances of objects, implemented by Embree. Independent of materials and lights, so
/// that scenes which differ only in these can share it.
class Geometry {
 public:
  /// Objects may contain instances of earlier objects. Throws InputError if Embree fails, or if instances are nested
  /// more than InstanceRows::kMost deep.
  Geometry(std::vector<ObjectParts> objects, ObjectParts world, int threads);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  bool intersect(const Ray& ray, uint64_t key, DetailedMaterials detailed, GeometryHit& met, Hit& hit) const;
  /// Embree's part of `intersect`, without the evaluation of the hit.
  bool closest(const Ray& ray, uint64_t key, RTCRayHit& query) const;
  bool occluded(const Ray& ray, uint64_t key) const;
  /// Same as World::intersect of packets. Sets only `hit` of the points.
  uint32_t intersect(const RayPacket& packet, DetailedMaterials detailed, GeometryHit* met, SurfacePoint* points) const;
  uint32_t closest(const RayPacket& packet, RTCRayHit8& query) const;
  uint32_t occluded(const RayPacket& packet) const;
  /// Bounds of the whole exposure.
  Bounds bounds() const;
  bool has_motion() const;
  /// Returns a bound of the coordinates of rays in the spaces of all objects, if they begin and end within `reach`
  /// units of the origin in each coordinate. Embree takes 1.8e18.
  float largest_ray_coordinate(float reach) const;

  /// Surfaces outside of objects. Only these can emit light.
  const std::vector<Surface>& surfaces() const;
  /// Returns the largest GeometryHit::instance.
  uint64_t instances() const;
  /// Returns the names of the instances' objects, each with the first number of those that have it, ascending.
  std::vector<std::pair<uint64_t, std::string>> instance_names() const;
  /// Returns the columns of all tables by name; the range covers all columns of that name.
  std::vector<InstanceColumn> columns() const;
  /// Returns the indices of the materials that surfaces have, ascending, except of objects without instances.
  std::vector<uint32_t> materials() const;
  /// Returns the bounds of one of `surfaces()`, and of all other geometry including instances, at the begin of the
  /// exposure.
  Bounds bounds_of(size_t surface) const;
  Bounds bounds_without(size_t surface) const;
  /// Calls `visit` for each surface: once, or once for each instance of its object, with its map to the world at the
  /// begin of the exposure and the number of the instance (0: none), always in the same order.
  using SurfaceVisitor = std::function<void(const Surface& surface, const AffineMap& to_world, uint64_t instance)>;
  void visit_surfaces(const SurfaceVisitor& visit) const;
  /// Returns one-sided areas by instance number minus 1, in scene units squared.
  std::vector<float> areas() const;

 private:
  bool closest(const Ray& ray, embree::Query& context, RTCRayHit& query) const;
  uint32_t closest(const RayPacket& packet, embree::Query& context, const int* valid, RTCRayHit8& query) const;
  void compute_hit(const RTCHit& at, const embree::Lane& lane, const Ray& ray, DetailedMaterials detailed,
                   GeometryHit& met, Hit& hit) const;
  embree::Scene new_scene() const;
  std::unique_ptr<GeometryObject> build(ObjectParts parts, uint64_t first_id);
  void attach(GeometryObject& object);
  void check() const;

  embree::Device device_;
  std::vector<std::unique_ptr<GeometryObject>> objects_;
  std::unique_ptr<GeometryObject> world_;
};

}  // namespace frond
