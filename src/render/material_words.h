#pragma once

#include <span>
#include <string>

#include "scene/description.h"
#include "scene/registry.h"

namespace frond {

/// A material as words give it: `abm specimen=soybean`.
struct MaterialWords {
  const MaterialInfo& info;
  ParsedPlugin plugin;
};

/// Throws InputError for words of another form, unknown names and values of the wrong type.
MaterialWords parse_material(std::span<const std::string> words, const Registry& registry);

/// A scene without shapes, in which every material goes by its plugin's name: for materials that take materials.
SceneDescription scene_of_materials(const Registry& registry);

}  // namespace frond
