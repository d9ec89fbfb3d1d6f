#pragma once

#include <vector>

#include "core/shape.h"

namespace frond {

/// Returns the bytes of a binary PLY file (little endian), with normals and texture coordinates (u, v) where the mesh
/// has them.
std::vector<unsigned char> ply_file(const TriangleMesh& mesh);

}  // namespace frond
