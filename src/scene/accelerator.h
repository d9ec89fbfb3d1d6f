#pragma once

#include <memory>
#include <vector>

#include "core/texture.h"
#include "core/world.h"
#include "scene/shape.h"

// Embree's, by name alone: who includes this header need not have Embree.
struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCRayHit;

namespace frond {

namespace embree {
struct Query;
struct Release {
  void operator()(RTCDeviceTy* device) const;
  void operator()(RTCSceneTy* scene) const;
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;
}  // namespace embree

/// A shape with what it is made of.
struct Primitive {
  ShapeGeometry geometry;
  const Material* material = nullptr;
  const AreaLight* light = nullptr;
  std::shared_ptr<const FloatTexture> alpha;  ///< null: opaque
  uint32_t material_id = 0;                   ///< as of a SurfacePoint
};

/// Places one group of primitives. 64 bytes for each copy, besides Embree's own record.
struct Placement {
  Transform world_from_object;
  size_t group;
};

/// Ray queries over primitives and instances of groups of primitives, by Embree.
class Accelerator {
 public:
  /// Throws InputError when Embree cannot build.
  Accelerator(std::vector<Primitive> top, std::vector<std::vector<Primitive>> groups,
              const std::vector<Placement>& instances, int threads);

  bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const;
  /// Embree's part of `intersect` alone.
  bool closest(const Ray& ray, uint64_t key, RTCRayHit& query) const;
  bool occluded(const Ray& ray, uint64_t key) const;
  Bounds bounds() const;

 private:
  /// The rows of an affine map: what a hit needs of an instance.
  struct Instance {
    std::array<Vec3, 3> rows;
    Vec3 translation;
    uint32_t group;

    Vec3 point(const Vec3& p) const;
    float largest_stretch() const;  ///< bound of the image's largest coordinate over the point's, without translation
    Vec3 normal(const Vec3& n) const;  ///< by the cofactors: the inverse transpose up to a positive factor
  };

  bool closest(const Ray& ray, embree::Query& context, RTCRayHit& query) const;
  void attach(RTCSceneTy* scene, const std::vector<Primitive>& primitives);
  void attach(RTCSceneTy* scene, const std::vector<Placement>& instances);
  void check() const;

  std::vector<Primitive> top_;
  std::vector<std::vector<Primitive>> groups_;
  std::vector<Instance> instances_;
  embree::Device device_;
  std::vector<embree::Scene> group_scenes_;
  embree::Scene scene_;
};

}  // namespace frond
