#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/math/vec.h"
#include "core/parallel.h"

namespace frond {

/// Triangle of a sheet, a connected set of triangles.
struct SheetTriangle {
  Vec3d a, b, c, normal;                  ///< unit normal; 0 for a triangle without area
  std::array<uint32_t, 3> vertices = {};  ///< numbers; equal positions have one number
  uint32_t sheet = 0;                     ///< first triangle of its sheet
};

/// Distance at which sheets count as coincident, relative to the tolerance.
inline constexpr double kCoincident = 0.01;
inline constexpr double kNotHidden = std::numeric_limits<double>::infinity();

/// Checks for a stop in a loop over this index.
inline void check_stop_now_and_then(size_t index) {
  if (index % 65536 == 0) check_stop();
}

/// Returns for each triangle the distance of its centroid behind the nearest triangle of an earlier sheet that faces
/// the other way, within `tolerance`; kNotHidden if there is none. Returns nothing if so many triangles lie at one
/// place that the comparisons would be more than some 100 for each.
std::optional<std::vector<double>> hidden_distances(const std::vector<SheetTriangle>& triangles, double tolerance);

}  // namespace frond
