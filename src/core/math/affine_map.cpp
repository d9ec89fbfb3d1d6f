#include "core/math/affine_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units/interval.h"

namespace frond {

AffineMap rounded_map(const PreciseTransform::Rows& rows) {
  AffineMap map;
  for (size_t i = 0; i < 3; ++i)
    std::ranges::transform(rows[i], map.rows[i].begin(), [](double v) { return float(v); });
  return map;
}

PreciseTransform::Rows precise_rows(const AffineMap& map) {
  PreciseTransform::Rows rows;
  for (size_t i = 0; i < 3; ++i) std::ranges::copy(map.rows[i], rows[i].begin());
  return rows;
}

/// Scales from 1e-9 to 1e9 keep ray coordinates within the range of float.
std::string problem_of(const AffineMap& map) {
  constexpr Interval kScale{1e-9, 1e9};
  if (!Transform(precise_rows(map)).is_valid()) return "its map cannot be inverted";
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    if (const double size = double(length(map.vector(axis))); !kScale.contains(size))
      return fmt::format("it scales by {:g}: {:g} to {:g} is the limit", size, kScale.min, kScale.max);
  return {};
}

}  // namespace frond
