#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/shape.h"

namespace frond {

/// What a PLY file holds: its triangles, and quadrilaterals over the same vertices, corners in their order around.
struct PlyMesh {
  TriangleMesh mesh;
  std::vector<std::array<uint32_t, 4>> quads;
  size_t ignored = 0;  ///< faces of fewer or more corners, which are left out
};

/// Triangles and quadrilaterals of a PLY file: ASCII or binary of either byte order, or what gzip has made of that;
/// `vertex` with x y z, optionally nx ny nz and a pair of texture coordinates (u v, s t, texture_u texture_v, texture_s
/// texture_t); `face` with vertex_indices or vertex_index. Whatever else the file holds is read over. Memory stays
/// within a small multiple of the file's size. Throws InputError with line and column (header, ASCII) or byte offset
/// (binary).
PlyMesh read_ply(const std::filesystem::path& path);

/// The same from bytes in memory; `name` is what errors call the file.
PlyMesh read_ply_text(std::string_view bytes, const std::string& name);

}  // namespace frond
