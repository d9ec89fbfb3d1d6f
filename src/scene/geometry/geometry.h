#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/shape.h"
#include "core/world.h"
#include "scene/geometry/instance_table.h"

// Embree's, by name alone: who includes this header need not have Embree.
struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCRayHit;
struct RTCRayHit8;
struct RTCHit;

namespace frond {

namespace embree {
struct Lane;
struct Query;
struct Release {
  void operator()(RTCDeviceTy* device) const;
  void operator()(RTCSceneTy* scene) const;
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;
}  // namespace embree

/// A shape, and which of the scene's things it is made of: places in lists, which are not the geometry's.
struct Surface {
  ShapeGeometry geometry;
  uint32_t material = 0;                      ///< in the scene's description
  std::optional<uint32_t> area_light = {};    ///< in the scene's description
  std::shared_ptr<const FloatTexture> alpha;  ///< null: opaque
};

/// Instances of objects: one for each row of the table.
struct Instances {
  std::shared_ptr<const InstanceTable> table;
  std::vector<uint32_t> objects;  ///< by row; a single one: the same for all
  AffineMap placement;            ///< of the whole table
  bool is_placed = false;         ///< false: `placement` is the identity
};

/// What stands together, and is placed as one: surfaces, and instances of other objects.
struct ObjectParts {
  std::vector<Surface> surfaces;
  std::vector<Instances> instances;
};

/// What a ray met: which things the numbers stand for, the scene knows.
struct GeometryHit {
  float t = 0;                      ///< along the ray
  uint32_t material = 0;            ///< as of a Surface
  std::optional<uint32_t> surface;  ///< of Geometry::surfaces, where the shape stands for itself
  uint32_t primitive = 0;           ///< of the surface
  uint64_t instance = 0;            ///< the instance, counted from 1; 0: the shape stands for itself
};

struct GeometryObject;

/// Materials, by their index, whose hits need derivatives; nullptr: none.
struct DetailedMaterials {
  const uint8_t* flags = nullptr;
  bool contains(uint32_t material) const { return flags && flags[material] != 0; }
};

/// Ray queries over surfaces and instances of objects, by Embree. It knows no material and no light: scenes that differ
/// in those share one.
class Geometry {
 public:
  /// Objects may hold instances of objects before them. Throws InputError when Embree cannot build, or they are nested
  /// more than InstanceRows::kMost deep.
  Geometry(std::vector<ObjectParts> objects, ObjectParts world, int threads);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  bool intersect(const Ray& ray, uint64_t key, DetailedMaterials detailed, GeometryHit& met, Hit& hit) const;
  /// Embree's part of `intersect` alone.
  bool closest(const Ray& ray, uint64_t key, RTCRayHit& query) const;
  bool occluded(const Ray& ray, uint64_t key) const;
  /// As World's of packets. Sets the points' hits alone.
  uint32_t intersect(const RayPacket& packet, DetailedMaterials detailed, GeometryHit* met, SurfacePoint* points) const;
  uint32_t closest(const RayPacket& packet, RTCRayHit8& query) const;
  uint32_t occluded(const RayPacket& packet) const;
  Bounds bounds() const;

  /// Surfaces that stand for themselves, which alone can give off light.
  const std::vector<Surface>& surfaces() const;
  /// The largest id of a GeometryHit.
  uint64_t instances() const;
  /// Columns of all tables, each name once: its range is that of all of that name.
  std::vector<InstanceColumn> columns() const;
  /// Areas of what has a number, of one of its sides, by the number less 1.
  std::vector<float> areas() const;

 private:
  bool closest(const Ray& ray, embree::Query& context, RTCRayHit& query) const;
  uint32_t closest(const RayPacket& packet, embree::Query& context, const int* valid, RTCRayHit8& query) const;
  void describe(const RTCHit& at, const embree::Lane& lane, const Ray& ray, DetailedMaterials detailed,
                GeometryHit& met, Hit& hit) const;
  std::unique_ptr<GeometryObject> build(ObjectParts parts, uint64_t first_id);
  void attach(GeometryObject& object);
  void check() const;

  embree::Device device_;
  std::vector<std::unique_ptr<GeometryObject>> objects_;
  std::unique_ptr<GeometryObject> world_;
};

}  // namespace frond
