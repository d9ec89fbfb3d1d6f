#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "imports/imported_scene.h"

namespace frond {

/// Materials of OBJ by name, and the images that they name.
struct ObjMaterials {
  std::map<std::string, ImportedMaterial> by_name;
  std::vector<ImportedImage> images;
};

/// Adds the materials of a material file (MTL). Statements that change the look of materials that are `used`, and are
/// not read, are added to `losses`.
void read_mtl(std::string_view text, const std::set<std::string>& used, ObjMaterials& materials, LossList& losses);

}  // namespace frond
