#include "render/material_words.h"

#include "core/math/random.h"

namespace frond {

MaterialWords parse_material(const std::string& text, const Registry& registry) {
  const PluginText parsed = parse_plugin_text(text, {});
  MaterialWords material{registry.materials.get(parsed.name, {}), {parsed.name, {}, {}}};
  set_params(parsed, material.info, {}, material.plugin);
  return material;
}

std::string words_of(const PluginText& material) {
  std::string words;
  for (const auto& [name, value] : material.params) words += (words.empty() ? "" : " ") + name + '=' + value;
  return words;
}

uint64_t material_seed(const std::string& text) {
  const PluginText material = parse_plugin_text(text, {});
  return hash_bytes(material.params.empty() ? material.name : material.name + ' ' + words_of(material));
}

SceneDescription scene_of_materials(const Registry& registry) {
  SceneDescription description;
  for (const std::string_view name : registry.materials.names())
    description.materials.push_back({std::string(name), {std::string(name), {}, {}}});
  return description;
}

}  // namespace frond
