#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/shape.h"

namespace frond {

/// Loop subdivision of a control mesh: splits faces `levels` times, then moves vertices to the limit surface and
/// computes limit normals (Loop 1987; boundaries as in Hoppe et al. 1994; in this form Pharr et al., Physically Based
/// Rendering, section 3.8). Unused vertices are dropped. Returns the error, with `result` unchanged, if the mesh is
/// invalid; "" otherwise.
std::string subdivide(const std::vector<Vec3>& cage, const std::vector<std::array<uint32_t, 3>>& faces, int levels,
                      TriangleMesh& result);

}  // namespace frond
