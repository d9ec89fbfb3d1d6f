#pragma once

#include <string>

#include "imports/imported_scene.h"
#include "imports/plant_geometry.h"

namespace frond {

/// Returns the directives of a scene file up to the shapes: the model's first camera, or one that sees the whole model;
/// its lights, or sun and sky. `scale`: scene units for one unit of the model.
std::string scene_view(const ImportedScene& scene, const PlantGeometry& geometry, const NodeMap& to_scene, double scale,
                       const std::string& stem);

}  // namespace frond
