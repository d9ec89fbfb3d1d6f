#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace frond {

/// Triangles over shared vertices. Every index is below p.size(); `n` and `uv` are empty or as long as `p`.
struct TriangleMesh {
  std::vector<Vec3> p;   ///< vertices
  std::vector<Vec3> n;   ///< shading normals, any length
  std::vector<Vec2> uv;  ///< texture coordinates
  std::vector<std::array<uint32_t, 3>> triangles;
};

}  // namespace frond
