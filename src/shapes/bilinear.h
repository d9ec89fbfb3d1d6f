#pragma once

#include "core/shape.h"

namespace frond {

/// Bilinear patches over shared corners. All indices are below p.size(); `n` and `uv` are empty or as long as `p`.
struct PatchMesh {
  std::vector<Vec3> p;                           ///< corners
  std::vector<Vec3> n;                           ///< shading normals, not normalized
  std::vector<Vec2> uv;                          ///< texture coordinates; if empty, each patch has its own (u, v)
  std::vector<std::array<uint32_t, 4>> patches;  ///< corners at (u, v) = (0,0), (1,0), (0,1), (1,1)
};

/// Returns the patches as a shape. The mesh is already in world space.
AnalyticShapePtr patches(PatchMesh mesh, const ShapePlacement& placement);

}  // namespace frond
