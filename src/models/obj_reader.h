#pragma once

#include <string_view>

#include "imports/imported_scene.h"
#include "models/file_source.h"

namespace frond {

/// Reads an OBJ file and its material files; `name` is its own, of which MODEL.mtl is taken where the material file
/// that it names is missing. Each group or object is a node. Vertices that lie far from the origin (is_far), as those
/// in map coordinates do, become relative to their median, in whole units. Statements that change the look and are not
/// read are losses. Throws std::runtime_error with the line for invalid vertices and faces.
ImportedScene read_obj(std::string_view text, const std::string& name, FileSource& files);

}  // namespace frond
