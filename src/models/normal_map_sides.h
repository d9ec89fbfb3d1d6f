#pragma once

#include <array>
#include <vector>

#include "imports/imported_scene.h"

namespace frond {

/// Adds a mesh, without vertices that no triangle has, to a scene, and its index to `to`. The y axis of a normal map
/// follows v of the model, or the sign of its tangents if it has some; in frond it completes a right-handed frame of
/// normal and u. Triangles where both are opposite become a mesh of their own, whose material has the normal map with y
/// inverted. Returns whether tangents have another direction than the texture coordinates, which frond follows.
bool add_by_side(ImportedMesh mesh, const std::vector<std::array<float, 4>>& tangents, ImportedScene& scene,
                 std::vector<uint32_t>& to);

}  // namespace frond
