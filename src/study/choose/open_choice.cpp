#include "study/choose/open_choice.h"

#include <algorithm>
#include <exception>

#include "core/log.h"
#include "scene/leaf_models.h"
#include "scene/overrides.h"
#include "scene/resolver.h"
#include "scene/scene_options.h"
#include "textures/normal_map.h"

namespace frond::choose {
namespace {

bool is_open(const MaterialDescription& m, const Registry& registry) {
  if (m.plugin.name != open_leaf(registry).name) return false;
  const ParsedParam* model = find_param(m.plugin.params, "model");
  return !model || model->values == decltype(model->values){std::vector<std::string>{"auto"}};
}

/// Adds the options that the leaf supports, up to the first exact one. The description is unchanged on return. Throws
/// the error of the first exact option if there is none.
void add_options(OpenChoice& open_choice, SceneSettings& description, const Registry& registry,
                 const WavelengthStrategy& wavelengths, const std::vector<ModelOption>& models) {
  const size_t place = open_choice.materials.front();
  ParsedPlugin& plugin = description.materials[place].plugin;
  const ParsedPlugin open = plugin;
  std::exception_ptr refusal;
  for (const ModelOption& option : models) {
    swap_material(plugin, option.plugin, registry, silent_log());
    try {
      SceneResolver(description, registry, wavelengths).material(place);
      open_choice.options.push_back(option);
    } catch (const InputError& error) {
      open_choice.refused.push_back({option.name, error.what()});
      if (option.is_exact && !refusal) refusal = std::current_exception();
    }
    plugin = open;
    if (!open_choice.options.empty() && open_choice.options.back().is_exact) return;
  }
  if (refusal) std::rethrow_exception(refusal);
}

/// The errors that a leaf states; the default of "maxrms" holds if it states none.
ErrorLimits limits_of(const Params& leaf) {
  ErrorLimits limits;
  if (leaf.given("maxrelativerms")) limits.relative = leaf.real("maxrelativerms");
  if (leaf.given("maxrms") || !leaf.given("maxrelativerms")) limits.absolute = leaf.real("maxrms");
  return limits;
}

}  // namespace

bool has_open_leaf(const SceneSettings& description, const Registry& registry) {
  return std::ranges::any_of(description.materials, [&](const auto& m) { return is_open(m, registry); });
}

bool names_wavelengths(const SceneSettings& description) { return find_param(description.options, "wavelengths"); }

std::vector<OpenChoice> open_leaves(const SceneSettings& description, const Registry& registry,
                                    const WavelengthStrategy& wavelengths, const Ladder& ladder) {
  std::vector<OpenChoice> leaves;
  SceneResolver resolver(description, registry, wavelengths);
  SceneSettings tried = description;
  for (size_t i = 0; i < description.materials.size(); ++i) {
    const MaterialDescription& m = description.materials[i];
    if (!is_open(m, registry)) continue;
    const auto alike = std::ranges::find_if(leaves, [&](const OpenChoice& q) {
      const MaterialDescription& other = description.materials[q.materials.front()];
      return m.name.empty() && other.name.empty() && same_plugin(m.plugin, other.plugin);
    });
    if (alike != leaves.end()) {
      alike->materials.push_back(i);
      continue;
    }
    const Params params(open_leaf(registry), split_bend(m.plugin, false), resolver);
    const std::string name = m.name.empty() ? fmt::format("leaf in line {}", m.plugin.where.line) : m.name;
    OpenChoice& open_choice = leaves.emplace_back(OpenChoice{name, {i}, limits_of(params), {}});
    add_options(open_choice, tried, registry, wavelengths, ladder.models);
  }
  return leaves;
}

void apply_answers(const std::vector<OpenChoice>& open_choices, const Configuration& answers, const Registry& registry,
                   SceneSettings& description) {
  for (size_t q = 0; q < open_choices.size(); ++q) {
    const ModelOption& answer = open_choices[q].options[answers[q]];
    if (!open_choices[q].is_leaf()) set_wavelengths(description, answer.name);
    for (const size_t place : open_choices[q].materials)
      swap_material(description.materials[place].plugin, answer.plugin, registry, silent_log());
  }
}

}  // namespace frond::choose
