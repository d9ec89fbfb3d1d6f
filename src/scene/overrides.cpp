#include "scene/overrides.h"

#include "scene/scene_options.h"

namespace frond {

void apply_overrides(const SceneOverrides& overrides, SceneSettings& description, const Registry& registry,
                     const Log& log) {
  apply_swaps(description, overrides.swaps, registry, log);
  if (const auto& text = overrides.integrator)
    override_plugin(*text, registry.integrators.get(text->name, {}), {}, description.integrator);
  if (const auto& text = overrides.filter)
    override_plugin(*text, registry.filters.get(text->name, {}), {}, description.filter);
  if (!overrides.wavelengths.empty()) set_wavelengths(description, overrides.wavelengths);
  if (overrides.seed) description.seed = overrides.seed;
  description.is_quick = description.is_quick || overrides.quick;
}

}  // namespace frond
