#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/mesh.h"

namespace frond {

/// Triangles of a PLY file: ASCII or binary of either byte order; `vertex` with x y z, optionally nx ny nz and a pair
/// of texture coordinates (u v, s t, texture_u texture_v, texture_s texture_t); `face` with vertex_indices or
/// vertex_index, quadrilaterals split in two. Whatever else the file holds is read over. Memory stays within a small
/// multiple of the file's size. Throws InputError with line and column (header, ASCII) or byte offset (binary).
TriangleMesh read_ply(const std::filesystem::path& path);

/// The same from bytes in memory; `name` is what errors call the file.
TriangleMesh read_ply_text(std::string_view bytes, const std::string& name);

}  // namespace frond
