#pragma once

#include <unordered_map>

#include "core/log.h"
#include "scene/scene.h"

namespace frond {

/// A scene with other leaves on the same shapes, and maybe other wavelengths: geometry, lights and view are the scene's
/// own, which must outlive it.
class SceneVariant final : public World {
 public:
  /// `description` differs from the scene's in leaf materials alone; of `overrides` the wavelengths count and the
  /// cache. `shared` holds what variants have in common. Throws InputError.
  SceneVariant(const Scene& scene, const SceneDescription& description, const Registry& registry,
               const SceneOverrides& overrides, ThreadPool& pool, const Log& log, SharedWork& shared);

  bool intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const override;
  bool occluded(const Ray& ray, uint64_t key) const override { return scene_.occluded(ray, key); }
  std::span<const Light* const> lights() const override { return scene_.lights(); }
  std::span<const EnvironmentLight* const> environment() const override { return scene_.environment(); }
  float radius() const override { return scene_.radius(); }
  const WavelengthStrategy& wavelengths() const override {
    return own_wavelengths_ ? *own_wavelengths_ : scene_.wavelengths();
  }

 private:
  const Scene& scene_;
  std::unique_ptr<WavelengthStrategy> own_wavelengths_;                   ///< nullptr: the scene's
  std::unordered_map<const Material*, std::shared_ptr<Material>> swaps_;  ///< by the scene's own
};

}  // namespace frond
