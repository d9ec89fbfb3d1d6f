#include "scene/scene_variant.h"

#include "core/log.h"
#include "scene/resolver.h"

namespace frond {

SceneVariant::SceneVariant(const Scene& scene, const SceneDescription& description, const Registry& registry,
                           const SceneOverrides& overrides, ThreadPool& pool, const Log& log, SharedWork& shared)
    : scene_(scene) {
  if (!overrides.wavelengths.empty() && overrides.wavelengths != scene.wavelengths_name())
    own_wavelengths_ = make_wavelengths(overrides.wavelengths, {}, description, registry);
  SceneResolver resolver(description, registry, wavelengths());
  // What was made ready for other wavelengths has to be made anew, leaf or not.
  for (size_t place = 0; place < description.materials.size(); ++place)
    if (const Material* from = scene.material(place); from && (own_wavelengths_ || from->is_leaf()))
      swaps_.emplace(from, resolver.material(place));
  const Preparation preparation{wavelengths(), pool, log, overrides.cache_dir, &shared};
  for (const auto& [place, material] : resolver.materials()) material->prepare(preparation);
}

bool SceneVariant::intersect(const Ray& ray, uint64_t key, SurfacePoint& point) const {
  if (!scene_.intersect(ray, key, point)) return false;
  if (const auto swap = swaps_.find(point.material); swap != swaps_.end()) point.material = swap->second.get();
  return true;
}

}  // namespace frond
