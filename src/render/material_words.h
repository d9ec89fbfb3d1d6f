#pragma once

#include <string>

#include "scene/format/description.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond {

/// Material given as text, such as `abm,specimen=soybean`.
struct MaterialWords {
  const MaterialInfo& info;
  ParsedPlugin plugin;
};

/// Parses a material. Throws InputError for syntax errors, unknown names and values of the wrong type.
MaterialWords parse_material(const std::string& text, const Registry& registry);

/// The parameters of a material, separated by blanks: `specimen=soybean thickness=1e-4`. The seeds of measurements are
/// hashes of this text, so that its format must not change.
std::string words_of(const PluginText& material);
/// Seed of a material's random numbers: hash of its name and its parameters.
uint64_t material_seed(const std::string& text);

/// Scene without shapes that has one named material for each material plug-in, under the plug-in's name. Materials with
/// parameters of kind material refer to these.
SceneDescription scene_of_materials(const Registry& registry);

}  // namespace frond
