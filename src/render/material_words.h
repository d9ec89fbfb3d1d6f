#pragma once

#include <string>

#include "scene/format/description.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond {

/// A material given in text: `abm,specimen=soybean`.
struct MaterialWords {
  const MaterialInfo& info;
  ParsedPlugin plugin;
};

/// Throws InputError for text of another form, unknown names and values of the wrong type.
MaterialWords parse_material(const std::string& text, const Registry& registry);

/// "specimen=soybean thickness=1e-4": the parameters with blanks between, "" where there are none. Random numbers hang
/// on this form.
std::string words_of(const PluginText& material);
/// What a material's random numbers begin with: the hash of its name and its parameters.
uint64_t material_seed(const std::string& text);

/// A scene without shapes, in which each material is named as its plugin: for materials that take materials.
SceneDescription scene_of_materials(const Registry& registry);

}  // namespace frond
