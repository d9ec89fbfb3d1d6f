#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/shape.h"

namespace frond {

/// Content of a PLY file: triangles, and quadrilaterals over the same vertices with corners in cyclic order.
struct PlyMesh {
  TriangleMesh mesh;
  std::vector<std::array<uint32_t, 4>> quads;
  size_t ignored = 0;  ///< number of faces with other numbers of corners, which are skipped
  std::string unused;  ///< names and counts of other properties and elements, which are skipped, for a message
  double step = 0;     ///< distance of neighbouring 32-bit floats at the first vertex, if the file has such; else 0
};

/// Reads triangles and quadrilaterals from a PLY file: ASCII, or binary in either byte order, or compressed by gzip;
/// `vertex` with x y z, optionally nx ny nz and texture coordinates (u v, s t, texture_u texture_v, texture_s
/// texture_t); `face` with vertex_indices or vertex_index, and texcoord (u v of each corner) if the vertices have none:
/// vertices whose corners differ are divided. Other content is skipped and named. Memory is a small
/// multiple of the file's size. Throws InputError with line and column (header, ASCII) or byte offset (binary).
/// `origin` is subtracted from the vertices before they are rounded.
PlyMesh read_ply(const std::filesystem::path& path, const Vec3d& origin = {});

/// Same for the bytes of a file, which may be compressed; `name` names the file in errors.
PlyMesh read_ply_bytes(const std::string& bytes, const std::string& name, const Vec3d& origin = {});

/// Same for bytes that are not compressed.
PlyMesh read_ply_text(std::string_view bytes, const std::string& name, const Vec3d& origin = {});

/// Some vertices of a file, to know where it lies before it is read.
struct PlySample {
  std::vector<Vec3d> points;  ///< the first ones, if the file has any
  uint64_t vertices;          ///< number of all
};

/// Returns nullopt for a file that cannot be read.
std::optional<PlySample> sample_ply(const std::filesystem::path& path);

}  // namespace frond
