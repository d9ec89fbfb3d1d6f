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
  /// Triangles whose second and third corners have changed places, so that they wind about the front; empty: none, or
  /// it does not matter, as there are texture coordinates.
  std::vector<bool> turned = {};
  /// From this triangle on they are halves of quadrilaterals, two by two: corners 0 1 2 and 0 2 3.
  size_t halves_from = SIZE_MAX;
};

}  // namespace frond
