#pragma once

#include <assimp/scene.h>

#include "imports/imported_scene.h"

namespace frond {

/// Returns the library's scene as plain data. Throws std::runtime_error if it has no triangles.
ImportedScene converted(const aiScene& scene);

/// Returns a material as plain data; images are added to `images`.
ImportedMaterial converted(const aiMaterial& material, const aiScene& scene, std::vector<ImportedImage>& images);

}  // namespace frond
