#include "scene/scene.h"

#include <algorithm>
#include <cmath>

#include "core/camera_samples.h"
#include "textures/normal_map.h"

namespace frond {

Scene::Scene() = default;
Scene::~Scene() = default;

CameraSampling Scene::camera_sampling() const { return camera_sampling(*sampler_); }

CameraSampling Scene::camera_sampling(const Sampler& sampler) const {
  return {.camera = *camera_,
          .wavelengths = *wavelengths_,
          .sampler = sampler,
          .width = film_.width,
          .height = film_.height,
          .pixel_jitter = has_pixel_jitter_,
          .wavelength_jitter = has_wavelength_jitter_,
          .has_motion = has_motion(),
          .camera_motion = camera_motion_ ? &*camera_motion_ : nullptr};
}

bool Scene::intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const {
  GeometryHit at;
  return intersect(ray, key, point, at);
}

bool Scene::intersect(const Ray& ray, uint64_t key, SurfacePoint& point, GeometryHit& at) const {
  if (!find_nearest(ray, key, at, point.hit)) return false;
  compute_point(at, point);
  return true;
}

/// A periodic scene traces rays one by one, because they pass different cells.
uint32_t Scene::intersect(const RayPacket& packet, SurfacePoint* points) const {
  if (tiling_) return World::intersect(packet, points);
  std::array<GeometryHit, RayPacket::kWidth> at;
  const uint32_t hits = geometry_->intersect(packet, {is_detailed_.data()}, at.data(), points);
  for (size_t i = 0; i < RayPacket::kWidth; ++i)
    if (hits >> i & 1) compute_point(at[i], points[i]);
  return hits;
}

/// Resolves the indices of a hit to material and light.
void Scene::compute_point(const GeometryHit& at, SurfacePoint& point) const {
  point.material = material_at_[at.material];
  point.light = at.surface ? lights_->of_surface[*at.surface].at(at.primitive) : nullptr;
  point.material_id = at.material;
  point.medium_interface = at.medium_interface;
  point.instance_id = at.instance;
  if (is_detailed_[at.material]) add_details(at.material, point.hit);
}

/// Sets the texture footprint, then applies a normal or bump map, which may use textures.
void Scene::add_details(uint32_t material, Hit& hit) const {
  footprint_.set(hit);
  if (bend_at_[material]) bend_at_[material]->bend(hit);
}

/// In a periodic scene, searches the cells along the ray for the nearest hit.
bool Scene::find_nearest(const Ray& ray, uint64_t key, GeometryHit& nearest, Hit& hit) const {
  if (!tiling_) return geometry_->intersect(ray, key, {is_detailed_.data()}, nearest, hit);
  float distance = INFINITY;
  return tiling_->march(ray, [&](const Tiling::Repeat& repeat) {
    Ray there = repeat.ray;
    there.t_max = std::min(there.t_max, distance - repeat.distance);
    if (!geometry_->intersect(there, key, {is_detailed_.data()}, nearest, hit)) return false;
    distance = repeat.distance + nearest.t;
    hit.p += repeat.shift;
    hit.extent = std::max(hit.extent, std::max(std::abs(hit.p.x), std::abs(hit.p.y)));
    return true;
  });
}

bool Scene::occluded(const Ray& ray, uint64_t key) const {
  if (!tiling_) return geometry_->occluded(ray, key);
  return tiling_->march(ray, [&](const Tiling::Repeat& repeat) { return geometry_->occluded(repeat.ray, key); });
}

uint32_t Scene::occluded(const RayPacket& packet) const {
  return tiling_ ? World::occluded(packet) : geometry_->occluded(packet);
}

}  // namespace frond
