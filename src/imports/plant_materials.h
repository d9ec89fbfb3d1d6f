#pragma once

#include <string>
#include <vector>

#include "core/params.h"
#include "imports/plant_images.h"

namespace frond {

/// Parameter whose texture is the brightness of the image of the model's colour, linear: `chlorophylla=@4:1`.
struct MappedParam {
  std::string name;
  double at_black, at_white;
};

/// Replacement for the materials of a model whose name matches a pattern: `--leaf`.
struct MaterialRule {
  std::string pattern;  ///< of the shell: * ? [a-z]
  ParsedPlugin material;
  std::vector<MappedParam> mapped = {};
  std::string text;  ///< as given, for messages
};

/// Materials of a model as directives of a scene file.
struct PlantMaterials {
  std::string text;                ///< Texture and MakeNamedMaterial directives
  std::vector<std::string> names;  ///< by index: names in the scene file; of the model, for materials without triangles
  std::vector<std::string> types;  ///< by index: plug-ins
  std::vector<std::string> alpha;  ///< by index: parameter of shapes for the opacity, or ""
  std::vector<std::string> emission;       ///< by index: AreaLightSource directive of shapes, or ""
  std::vector<const MaterialRule*> rules;  ///< by index: that has made the material, or nullptr
  LossList losses;
};

/// Returns whether a name matches a pattern of the shell, in upper or lower case.
bool matches_pattern(const std::string& pattern, const std::string& name);

/// Writes the materials. `used` says which ones have triangles: others are left out. Throws InputError if a rule
/// matches none of them.
PlantMaterials plant_materials(const ImportedScene& scene, const std::vector<bool>& used,
                               const std::vector<MaterialRule>& rules, PlantImages& images, const Log& log);

}  // namespace frond
