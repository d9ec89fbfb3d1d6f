#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "imports/plant_geometry.h"

namespace frond {

/// Sheets that a model has twice, front and back as two surfaces. A leaf material stands for both faces of a leaf and
/// transmits light: through two sheets light passes two leaves.
struct DoubleSheet {
  uint32_t material = 0;  ///< of the second sheet
  size_t triangles = 0;   ///< of the second sheet
  double apart = 0;       ///< largest distance of the two, scene units; 0: they coincide
  bool operator==(const DoubleSheet&) const = default;
};

/// Finds connected sheets of triangles that lie behind another sheet, which faces the other way, within `tolerance`
/// (units of the meshes). Returns one entry for each material, and removes the second sheets of the materials that
/// `remove` states. Returns nothing, and changes nothing, if too many triangles lie at one place to compare them.
std::optional<std::vector<DoubleSheet>> double_sheets(std::vector<PlantMesh>& meshes, double tolerance,
                                                      const std::vector<bool>& remove);

}  // namespace frond
