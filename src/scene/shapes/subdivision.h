#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/shape.h"

namespace frond {

/// A control mesh's faces cut into four so many times by Loop's rules, with vertices then put on the limit surface, and
/// the normals that it has there (Loop 1987; boundaries as Hoppe et al. 1994; in this form Pharr et al., Physically
/// Based Rendering, section 3.8). Says what is wrong with the mesh, and leaves `result` alone, where no surface follows
/// from it; "" otherwise. Vertices that no face has are left out.
std::string subdivide(const std::vector<Vec3>& cage, const std::vector<std::array<uint32_t, 3>>& faces, int levels,
                      TriangleMesh& result);

}  // namespace frond
