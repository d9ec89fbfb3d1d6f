#pragma once

#include "imports/imported_scene.h"

namespace frond {

/// Adds losses that the geometry shows: normal maps on mirrored texture coordinates, which frond would have inverted,
/// and normals that are not used because some are 0.
void add_geometry_losses(ImportedScene& scene);

}  // namespace frond
