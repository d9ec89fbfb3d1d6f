#include "render/material_words.h"

#include <fmt/ranges.h>

#include "scene/plugin_text.h"

namespace frond {

MaterialWords parse_material(std::span<const std::string> words, const Registry& registry) {
  PluginText text{words[0], {}};
  for (const std::string& word : words.subspan(1)) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size())
      fail({}, "a material looks like NAME parameter=value ...: \"{}\" in {}", word, fmt::join(words, " "));
    text.params.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  MaterialWords material{registry.materials.get(text.name, {}), {text.name, {}, {}}};
  set_params(text, material.info, {}, material.plugin);
  return material;
}

SceneDescription scene_of_materials(const Registry& registry) {
  SceneDescription description;
  for (const std::string_view name : registry.materials.names())
    description.materials.push_back({std::string(name), {std::string(name), {}, {}}});
  return description;
}

}  // namespace frond
