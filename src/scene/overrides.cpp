#include "scene/overrides.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "core/log.h"
#include "scene/leaf_models.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "textures/normal_map.h"

namespace frond {
namespace {

/// Replacement of materials by one other. Parameters that this material does not have are removed, with one warning for
/// all replaced materials.
class Replacement {
 public:
  Replacement(const PluginText& to, const Registry& registry, const Location& where)
      : to_(to), info_(registry.materials.get(to.name, where)), where_(where) {}

  /// Throws InputError.
  void apply(ParsedPlugin& plugin) {
    std::erase_if(plugin.params, [this](const ParsedParam& given) {
      if (find_param(info_, given.name) || find_param(normal_bend_params, given.name)) return false;
      if (left_out_.empty()) first_ = given.where;
      if (std::ranges::find(left_out_, given.name) == left_out_.end()) left_out_.push_back(given.name);
      return true;
    });
    set_params(to_, info_, where_, plugin);
    plugin.name = to_.name;
  }
  /// Warns of the removed parameters, at the first one.
  void warn(const Log& log) const {
    if (left_out_.empty()) return;
    log.warn(first_, fmt::format("\"{}\" has no parameter{} \"{}\": left out by the swap", info_.name,
                                 left_out_.size() == 1 ? "" : "s", fmt::join(left_out_, "\", \"")));
  }

 private:
  const PluginText& to_;
  const MaterialInfo& info_;
  const Location& where_;
  std::vector<std::string> left_out_;
  Location first_;
};

/// Returns the indices of the materials that a swap replaces. Throws InputError if there are none.
std::vector<size_t> swapped_materials(const SceneSettings& description, const MaterialSwap& swap,
                                      const Registry& registry) {
  if (swap.from == "*") {
    auto leaves = leaf_materials(description, registry);
    if (leaves.empty()) fail(swap.where, "swap: none of the scene's materials is a leaf");
    return leaves;
  }
  std::vector<std::string_view> names;
  std::vector<size_t> found;
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const MaterialDescription& m = description.materials[i];
    names.push_back(m.shown_name());
    if (m.name == swap.from || m.plugin.name == swap.from) found.push_back(i);
  }
  if (found.empty())
    fail(swap.where, "swap: the scene has no material \"{}\"{}", swap.from, suggestion(swap.from, names));
  return found;
}

}  // namespace

void swap_material(ParsedPlugin& plugin, const PluginText& to, const Registry& registry, const Log& log,
                   const Location& where) {
  Replacement replacement(to, registry, where);
  replacement.apply(plugin);
  replacement.warn(log);
}

void apply_swaps(SceneSettings& description, const std::vector<MaterialSwap>& swaps, const Registry& registry,
                 const Log& log) {
  for (const MaterialSwap& swap : swaps) {
    const auto materials = swapped_materials(description, swap, registry);
    Replacement replacement(swap.to, registry, swap.where);
    for (const size_t i : materials) replacement.apply(description.materials[i].plugin);
    replacement.warn(log);
  }
}

void apply_overrides(const SceneOverrides& overrides, SceneSettings& description, const Registry& registry,
                     const Log& log) {
  apply_swaps(description, overrides.swaps, registry, log);
  if (const auto& text = overrides.integrator)
    override_plugin(*text, registry.integrators.get(text->name, text->where), text->where, description.integrator);
  if (const auto& text = overrides.filter)
    override_plugin(*text, registry.filters.get(text->name, text->where), text->where, description.filter);
  if (overrides.separate_pixels) {
    ParsedPlugin& filter = description.filter;
    override_plugin({filter.name, {{"reconstruction", "importance"}}}, registry.filters.get(filter.name, filter.where),
                    {}, filter);
  }
  if (!overrides.wavelengths.empty())
    set_wavelengths(description, overrides.wavelengths, {std::make_shared<const std::string>("--wavelengths")});
  if (overrides.seed) description.seed = overrides.seed;
  description.is_quick = description.is_quick || overrides.quick;
}

}  // namespace frond
