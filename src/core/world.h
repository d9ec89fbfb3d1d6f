#pragma once

#include <span>

#include "core/light.h"
#include "core/material.h"
#include "core/ray.h"

namespace frond {

/// Where a ray meets the scene.
struct SurfacePoint {
  Hit hit;
  const Material* material = nullptr;
  const AreaLight* light = nullptr;  ///< nullptr: the surface gives off no light
  uint32_t material_id = 0;          ///< place of the material in the scene's description
  uint64_t instance_id = 0;          ///< of the copy of an object, counted from 1; 0: the shape stands for itself
};

/// What an integrator sees of a scene. Thread-safe. `key` feeds the random numbers of partly transparent surfaces
/// (`alpha`); it must differ from ray to ray.
class World {
 public:
  virtual ~World() = default;
  virtual bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const = 0;
  virtual bool occluded(const Ray& ray, uint64_t key) const = 0;
  virtual std::span<const Light* const> lights() const = 0;
  /// Those of `lights` that surround the scene.
  virtual std::span<const EnvironmentLight* const> environment() const = 0;
  /// Radius of a sphere around everything.
  virtual float radius() const = 0;
  /// Of its paths; its materials are made ready for them.
  virtual const WavelengthStrategy& wavelengths() const = 0;
};

/// A ray from a hit that cannot meet the same surface again: the origin is lifted off along ng, to the side of `d`.
inline Vec3 offset_origin(const Hit& hit, const Vec3& d) {
  // 2^-17 of the largest coordinate behind p leaves room for barycentrics and an instance's transform: 8 um at 1 m.
  const float lift = hit.extent * 0x1p-17f + 0x1p-40f;
  return hit.p + hit.ng * (dot(d, hit.ng) < 0 ? -lift : lift);
}

}  // namespace frond
