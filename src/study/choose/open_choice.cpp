#include "study/choose/open_choice.h"

#include <algorithm>

#include "core/log.h"
#include "scene/overrides.h"
#include "scene/resolver.h"
#include "scene/scene_options.h"
#include "scene/textures/normal_map.h"

namespace frond::choose {
namespace {

bool is_open(const MaterialDescription& m) {
  if (m.plugin.name != "leaf") return false;
  const ParsedParam* model = find_param(m.plugin.params, "model");
  return !model || model->values == decltype(model->values){std::vector<std::string>{"auto"}};
}

/// Whether the model accepts `word` for its parameter `name`.
bool takes(const Registry& registry, std::string_view model, std::string_view name, const std::string& word) {
  const MaterialInfo* info = registry.materials.find(model);
  const Param* param = info ? find_param(*info, name) : nullptr;
  return !param || std::ranges::count(param->choices, word) > 0;
}

/// Returns the reference option: the last of the ladder, except that random walks cannot be reciprocal.
const ModelOption* right_for(const ParsedPlugin& leaf, const Registry& registry,
                             const std::vector<ModelOption>& models) {
  const ParsedParam* incident = find_param(leaf.params, "incident");
  const auto* words = incident ? std::get_if<std::vector<std::string>>(&incident->values) : nullptr;
  if (!words || words->size() != 1) return &models.back();
  const auto right = std::ranges::find_if(models.rbegin(), models.rend(), [&](const ModelOption& option) {
    return takes(registry, option.name, "incident", words->front());
  });
  return right == models.rend() ? &models.back() : &*right;
}

/// Adds the options that the leaf supports. The description is unchanged on return.
void add_options(OpenChoice& open_choice, SceneSettings& description, const Registry& registry,
                 const WavelengthStrategy& wavelengths, const std::vector<ModelOption>& models) {
  const size_t place = open_choice.materials.front();
  ParsedPlugin& plugin = description.materials[place].plugin;
  const ParsedPlugin open = plugin;
  const ModelOption* right = right_for(open, registry, models);
  for (const ModelOption& option : models) {
    swap_material(plugin, option.plugin, registry, silent_log());
    try {
      SceneResolver(description, registry, wavelengths).material(place);
      open_choice.options.push_back(option);
    } catch (const InputError& error) {
      if (&option == right) throw;
      open_choice.refused.push_back({option.name, error.what()});
    }
    plugin = open;
  }
}

}  // namespace

bool has_open_leaf(const SceneSettings& description) { return std::ranges::any_of(description.materials, is_open); }

bool names_wavelengths(const SceneSettings& description) { return find_param(description.options, "wavelengths"); }

std::vector<OpenChoice> open_leaves(const SceneSettings& description, const Registry& registry,
                                    const WavelengthStrategy& wavelengths, const Ladder& ladder) {
  std::vector<OpenChoice> leaves;
  SceneResolver resolver(description, registry, wavelengths);
  SceneSettings tried = description;
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const MaterialDescription& m = description.materials[i];
    if (!is_open(m)) continue;
    const auto alike = std::ranges::find_if(leaves, [&](const OpenChoice& q) {
      const MaterialDescription& other = description.materials[q.materials.front()];
      return m.name.empty() && other.name.empty() && same_plugin(m.plugin, other.plugin);
    });
    if (alike != leaves.end()) {
      alike->materials.push_back(i);
      continue;
    }
    const Params params(registry.materials.get("leaf", m.plugin.where), split_bend(m.plugin, false), resolver);
    const std::string name = m.name.empty() ? fmt::format("leaf in line {}", m.plugin.where.line) : m.name;
    OpenChoice& open_choice = leaves.emplace_back(OpenChoice{name, {i}, params.real("maxrms"), {}});
    add_options(open_choice, tried, registry, wavelengths, ladder.models);
  }
  return leaves;
}

void put_answers(const std::vector<OpenChoice>& open_choices, const Configuration& answers, const Registry& registry,
                 SceneSettings& description) {
  for (size_t q = 0; q < open_choices.size(); ++q) {
    const ModelOption& answer = open_choices[q].options[answers[q]];
    if (!open_choices[q].is_leaf()) set_wavelengths(description, answer.name);
    for (const size_t place : open_choices[q].materials)
      swap_material(description.materials[place].plugin, answer.plugin, registry, silent_log());
  }
}

}  // namespace frond::choose
