#include "scene/leaf_models.h"

#include <algorithm>
#include <ranges>
#include <set>
#include <stdexcept>

#include "core/leaf_models.h"
#include "scene/format/plugin_text.h"

namespace frond {
namespace {

/// Returns the first of `infos` for which `holds`. Registries without one are a defect of the program.
template <class Infos, class Holds>
const MaterialInfo& first_of(Infos&& infos, const char* what, const Holds& holds) {
  const auto found = std::ranges::find_if(infos, holds);
  if (found == infos.end()) throw std::logic_error(std::string("the registry has no ") + what);
  return **found;
}

/// Whether a mixture names one of these materials.
bool contains_material(const ParsedPlugin& mixture, const MaterialInfo& info,
                       const std::set<std::string_view>& materials) {
  for (const Param& p : info.params) {
    const ParsedParam* given = p.kind == ParamKind::material ? find_param(mixture.params, p.name) : nullptr;
    const auto* names = given ? std::get_if<std::vector<std::string>>(&given->values) : nullptr;
    if (names && std::ranges::any_of(*names, [&](const std::string& name) { return materials.contains(name); }))
      return true;
  }
  return false;
}

}  // namespace

std::vector<const MaterialInfo*> leaf_models(const Registry& registry) { return leaf_models(registry.materials.all()); }

const MaterialInfo& open_leaf(const Registry& registry) {
  return first_of(registry.materials.all(), "open leaf material",
                  [](const MaterialInfo* info) { return info->leaf && info->leaf->is_open; });
}

const MaterialInfo& reference_model(const Registry& registry) {
  const MaterialInfo* found = reference_model(registry.materials.all());
  if (!found) throw std::logic_error("the registry has no leaf model that is a reference");
  return *found;
}

bool is_exact(const MaterialInfo& model, const Registry& registry) {
  return model.leaf && model.leaf->is_exact && model.leaf->reference == reference_model(registry).name;
}

const MaterialInfo& noiseless_model(const Registry& registry) {
  return first_of(leaf_models(registry), "exact leaf model without noise",
                  [&](const MaterialInfo* info) { return is_exact(*info, registry) && !info->leaf->is_noisy; });
}

const MaterialInfo& model_with(LeafModel::Table table, const Registry& registry) {
  const auto models = leaf_models(registry);
  return first_of(std::views::reverse(models), "leaf model with such a table",
                  [table](const MaterialInfo* info) { return info->leaf->table == table; });
}

bool reads_table(const ParsedPlugin& plugin, const Registry& registry) {
  const MaterialInfo* info = registry.materials.find(plugin.name);
  return info && info->leaf && info->leaf->table != LeafModel::Table::none &&
         find_param(plugin.params, LeafModel::kTableFile);
}

std::string quiet_text(const MaterialInfo& model) {
  const LeafModel::Variant& quiet = model.leaf->quiet;
  if (quiet.parameter.empty()) return std::string(model.name);
  return fmt::format("{},{}={}", model.name, quiet.parameter, quiet.value);
}

bool is_mixture(const MaterialInfo& info) {
  return std::ranges::any_of(info.params, [](const Param& p) { return p.kind == ParamKind::material; });
}

std::vector<uint8_t> leaf_flags(const SceneSettings& description, const Registry& registry) {
  std::vector<uint8_t> flags(description.materials.size());
  std::set<std::string_view> leaves;
  // Mixtures of mixtures follow in later rounds.
  for (bool grows = true; grows;) {
    grows = false;
    for (size_t i = 0; i < flags.size(); ++i) {
      const auto& [name, plugin] = description.materials[i];
      const MaterialInfo* info = registry.materials.find(plugin.name);
      if (flags[i] || !info || !(info->leaf || contains_material(plugin, *info, leaves))) continue;
      flags[i] = 1, grows = true;
      if (!name.empty()) leaves.insert(name);
    }
  }
  return flags;
}

std::vector<size_t> leaf_materials(const SceneSettings& description, const Registry& registry) {
  std::vector<size_t> leaves;
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const ParsedPlugin& plugin = description.materials[i].plugin;
    if (registry.materials.get(plugin.name, plugin.where).leaf) leaves.push_back(i);
  }
  return leaves;
}

}  // namespace frond
