#pragma once

#include <string_view>

#include "imports/imported_scene.h"
#include "models/file_source.h"

namespace frond {

/// Reads a glTF 2 file (.gltf, .glb). What its scene has and the import does not read is among the losses: its JSON is
/// compared with the record in gltf_properties.h. Throws std::runtime_error with the place in the JSON.
ImportedScene read_gltf(std::string_view bytes, FileSource& files);

}  // namespace frond
