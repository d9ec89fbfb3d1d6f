#include "scene/math/affine_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/spectrum.h"

namespace frond {

/// Inverts by cofactors in double precision.
PreciseTransform::PreciseTransform(const Transform& t) {
  const Transform::Rows& m = t.rows();
  const auto column = [&m](size_t j) { return Vec3d{double(m[0][j]), double(m[1][j]), double(m[2][j])}; };
  x_ = column(0), y_ = column(1), z_ = column(2), translation_ = column(3);
  const Vec3d yz = cross(y_, z_);
  const double scale = 1 / dot(x_, yz);
  row_x_ = yz * scale, row_y_ = cross(z_, x_) * scale, row_z_ = cross(x_, y_) * scale;
}

/// Scales from 1e-9 to 1e9 keep ray coordinates within the range of float.
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
