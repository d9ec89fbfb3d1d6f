#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace frond {

/// Returns the triangles of a plane polygon, by the indices of its corners in their order: a fan if it is convex,
/// otherwise ears that are cut off. A polygon that intersects itself, or is not plane, has some triangles too.
std::vector<std::array<uint32_t, 3>> triangulated(const std::vector<Vec3d>& corners);

}  // namespace frond
