#pragma once

#include "core/shape.h"

namespace frond {

/// Bilinear patches over shared corners. Every index is below p.size(); `n` and `uv` are empty or as long as `p`.
struct PatchMesh {
  std::vector<Vec3> p;                           ///< corners
  std::vector<Vec3> n;                           ///< shading normals, any length
  std::vector<Vec2> uv;                          ///< texture coordinates; by default each patch has its own (u, v)
  std::vector<std::array<uint32_t, 4>> patches;  ///< corners at (u, v) = (0,0), (1,0), (0,1), (1,1)
};

/// Of a mesh that is in the scene's space already.
AnalyticShapePtr patches(PatchMesh mesh, const ShapePlacement& placement);

}  // namespace frond
