#include "scene/affine_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/spectrum.h"

namespace frond {

std::string problem_of(const AffineMap& map) {
  constexpr Interval kScale{1e-9, 1e9};
  Transform::RowsDouble rows;
  for (size_t i = 0; i < 3; ++i) std::copy(map.rows[i].begin(), map.rows[i].end(), rows[i].begin());
  if (!Transform(rows).is_valid()) return "its map cannot be inverted";
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    if (const double size = double(length(map.vector(axis))); !kScale.contains(size))
      return fmt::format("it scales by {:g}: {:g} to {:g} is the limit", size, kScale.min, kScale.max);
  return {};
}

}  // namespace frond
