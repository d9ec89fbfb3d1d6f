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
  uint32_t material_id = 0;          ///< index of the material in the scene's description
  uint64_t instance_id = 0;          ///< of the instance of an object, counted from 1; 0: the shape stands for itself
};

/// Rays that begin close to each other and go nearly the same way: they are traced together.
struct RayPacket {
  static constexpr int kWidth = 8;
  const Ray* rays;       ///< kWidth of them
  const uint64_t* keys;  ///< of each, as of one ray
  uint32_t lanes = 0;    ///< which of them are there, by bit
};

/// What an integrator sees of a scene. Thread-safe. `key` feeds the random numbers of partly transparent surfaces
/// (`alpha`); it must differ from ray to ray.
class World {
 public:
  virtual ~World() = default;
  virtual bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const = 0;
  virtual bool occluded(const Ray& ray, uint64_t key) const = 0;
  /// Which of the packet's rays meet something, by bit; `points` has one for each lane. Where two surfaces are at the
  /// same distance, which of them it is may hang on what else is in the packet.
  virtual uint32_t intersect(const RayPacket& packet, SurfacePoint* points) const;
  /// Which of them something is in the way of.
  virtual uint32_t occluded(const RayPacket& packet) const;
  virtual std::span<const Light* const> lights() const = 0;
  /// Those of `lights` that surround the scene.
  virtual std::span<const EnvironmentLight* const> environment() const = 0;
  /// Radius of a sphere around everything.
  virtual float radius() const = 0;
  /// Of its paths; its materials are made ready for them.
  virtual const WavelengthStrategy& wavelengths() const = 0;
};

inline uint32_t World::intersect(const RayPacket& packet, SurfacePoint* points) const {
  uint32_t hits = 0;
  for (size_t i = 0; i < RayPacket::kWidth; ++i)
    if ((packet.lanes >> i & 1) && intersect(packet.rays[i], packet.keys[i], points[i])) hits |= 1u << i;
  return hits;
}

inline uint32_t World::occluded(const RayPacket& packet) const {
  uint32_t hits = 0;
  for (size_t i = 0; i < RayPacket::kWidth; ++i)
    if ((packet.lanes >> i & 1) && occluded(packet.rays[i], packet.keys[i])) hits |= 1u << i;
  return hits;
}

/// A ray from a hit that cannot meet the same surface again: the origin is lifted off along ng, to the side of `d`.
inline Vec3 offset_origin(const Hit& hit, const Vec3& d) {
  // 2^-17 of the largest coordinate behind p leaves room for barycentrics and an instance's transform: 8 um at 1 m.
  const float lift = hit.extent * 0x1p-17f + 0x1p-40f;
  return hit.p + hit.ng * (dot(d, hit.ng) < 0 ? -lift : lift);
}

}  // namespace frond
