#pragma once

#include <limits>
#include <span>

#include "core/light.h"
#include "core/material.h"
#include "core/math/ray.h"

namespace frond {

class Medium;

/// Participating media on the two sides of a surface; nullptr: vacuum.
struct MediumInterface {
  const Medium* inside = nullptr;   ///< on the side away from the geometric normal
  const Medium* outside = nullptr;  ///< on the side of the geometric normal
};

/// Intersection of a ray with the scene.
struct SurfacePoint {
  Hit hit;
  const Material* material = nullptr;
  const AreaLight* light = nullptr;  ///< nullptr if the surface does not emit
  uint32_t material_id = 0;          ///< index of the material in the scene's description
  uint32_t medium_interface = 0;     ///< 1 + index in World::medium_interfaces; 0: the medium is the same on both sides
  uint64_t instance_id = 0;          ///< index of the instance of an object, from 1; 0 if the shape is not instanced
};

/// Rays with similar origins and directions, which are traced together.
struct RayPacket {
  static constexpr int kWidth = 8;
  const Ray* rays;       ///< kWidth rays
  const uint64_t* keys;  ///< one for each ray; see World
  uint32_t lanes = 0;    ///< bit i is set if ray i is valid
};

/// Scene as seen by an integrator. Thread-safe. `key` is the key of the random numbers for partly transparent surfaces
/// (`alpha`); it must differ between rays.
class World {
 public:
  virtual ~World() = default;
  /// Finds the nearest intersection with t in (0, ray.t_max) and writes it to `point`; returns false if there is none.
  virtual bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const = 0;
  /// True if the ray meets any surface with t in (0, ray.t_max).
  virtual bool occluded(const Ray& ray, uint64_t key) const = 0;
  /// Intersects all rays of a packet: sets bit i of the result and points[i] if ray i meets a surface. If two surfaces
  /// are at the same distance, the one reported can depend on the other rays of the packet.
  virtual uint32_t intersect(const RayPacket& packet, SurfacePoint* points) const;
  /// Sets bit i of the result if ray i meets any surface.
  virtual uint32_t occluded(const RayPacket& packet) const;
  /// All lights; Light::index is the index in this list.
  virtual std::span<const Light* const> lights() const = 0;
  /// The environment lights among `lights`.
  virtual std::span<const EnvironmentLight* const> environment() const = 0;
  /// Media of the scene's surfaces, and the medium in which camera rays begin (nullptr: vacuum).
  virtual std::span<const MediumInterface> medium_interfaces() const { return {}; }
  virtual const Medium* camera_medium() const { return nullptr; }
  /// Radius of a sphere that contains the scene.
  virtual float radius() const = 0;
  /// Wavelength strategy of the render, for which the materials have been prepared.
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

/// Origin for a ray that leaves a hit in the direction `d` and must not intersect the same surface again: the point,
/// offset along ng to the side of `d`.
inline Vec3 offset_origin(const Hit& hit, const Vec3& d) {
  // 2^-17 of the largest coordinate (8 um at 1 m) exceeds the errors of barycentrics and of an instance's transform.
  const float lift = hit.extent * 0x1p-17f + 0x1p-40f;
  return hit.p + hit.ng * (dot(d, hit.ng) < 0 ? -lift : lift);
}

/// Sets a ray that leaves a hit in the direction `d`, without an end. Its time remains. In place: a copy right after
/// its members were written would stall on store forwarding.
inline void set_leaving_ray(const Hit& hit, const Vec3& d, Ray& ray) {
  ray.o = offset_origin(hit, d);
  ray.d = d;
  ray.t_max = std::numeric_limits<float>::infinity();
}

}  // namespace frond
