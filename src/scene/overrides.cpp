#include "scene/overrides.h"

#include <algorithm>

#include "core/log.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "scene/textures/normal_map.h"

namespace frond {
namespace {

/// Removes parameters that the material does not have, each with a warning.
void leave_out_unknown(const MaterialInfo& info, ParsedPlugin& plugin, const Log& log) {
  std::erase_if(plugin.params, [&](const ParsedParam& given) {
    if (find_param(info, given.name) || find_param(normal_bend_params, given.name)) return false;
    log.warn(given.where, fmt::format("\"{}\" has no parameter \"{}\": left out by the swap", info.name, given.name));
    return true;
  });
}

void apply_swap_to_leaves(SceneSettings& description, const MaterialSwap& swap, const Registry& registry,
                          const Log& log) {
  const auto leaves = Scene::leaf_materials(description, registry);
  if (leaves.empty()) fail(swap.where, "swap: none of the scene's materials is a leaf");
  for (const size_t i : leaves) swap_material(description.materials[i].plugin, swap.to, registry, log, swap.where);
}

}  // namespace

void swap_material(ParsedPlugin& plugin, const PluginText& to, const Registry& registry, const Log& log,
                   const Location& where) {
  const MaterialInfo& info = registry.materials.get(to.name, where);
  leave_out_unknown(info, plugin, log);
  set_params(to, info, where, plugin);
  plugin.name = to.name;
}

void apply_swaps(SceneSettings& description, const std::vector<MaterialSwap>& swaps, const Registry& registry,
                 const Log& log) {
  for (const MaterialSwap& swap : swaps) {
    if (swap.from == "*") {
      apply_swap_to_leaves(description, swap, registry, log);
      continue;
    }
    std::vector<std::string_view> names;
    bool found = false;
    for (MaterialDescription& m : description.materials) {
      names.push_back(m.name.empty() ? m.plugin.name : m.name);
      if (m.name != swap.from && m.plugin.name != swap.from) continue;
      swap_material(m.plugin, swap.to, registry, log, swap.where);
      found = true;
    }
    if (!found) fail(swap.where, "swap: the scene has no material \"{}\"{}", swap.from, suggestion(swap.from, names));
  }
}

void apply_overrides(const SceneOverrides& overrides, SceneSettings& description, const Registry& registry,
                     const Log& log) {
  apply_swaps(description, overrides.swaps, registry, log);
  if (const auto& text = overrides.integrator)
    override_plugin(*text, registry.integrators.get(text->name, {}), {}, description.integrator);
  if (const auto& text = overrides.filter)
    override_plugin(*text, registry.filters.get(text->name, {}), {}, description.filter);
  if (!overrides.wavelengths.empty())
    set_wavelengths(description, overrides.wavelengths, {std::make_shared<const std::string>("--wavelengths")});
  if (overrides.seed) description.seed = overrides.seed;
  description.is_quick = description.is_quick || overrides.quick;
}

}  // namespace frond
