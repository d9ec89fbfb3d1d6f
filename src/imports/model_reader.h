#pragma once

#include <filesystem>

#include "imports/imported_scene.h"

namespace frond {

/// Reads a model file (.obj, .gltf, .glb) in a child process with limits on memory and time (src/models). Files
/// that the model names are read in its folder and below only. Throws InputError with the name of the file.
ImportedScene read_model(const std::filesystem::path& path);

}  // namespace frond
