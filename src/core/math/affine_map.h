#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/math/float4.h"
#include "core/math/precise_transform.h"

namespace frond {

/// Returns the largest absolute value of the coordinates.
inline float largest_coordinate(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Transform of an instance, without a stored inverse to save memory.
struct AffineMap {
  Transform::Rows rows;

  Vec3 translation() const { return {rows[0][3], rows[1][3], rows[2][3]}; }
  Vec3 vector(const Vec3& v) const { return {dot(row(0), v), dot(row(1), v), dot(row(2), v)}; }
  Vec3 point(const Vec3& p) const { return vector(p) + translation(); }
  /// Transforms a normal by the cofactor matrix: the inverse transpose times the determinant. The length of the result
  /// is the factor on areas with this unit normal.
  Vec3 normal(const Vec3& n) const {
    const Vec3 c0 = cross(row(1), row(2)), c1 = cross(row(2), row(0)), c2 = cross(row(0), row(1));
    const float sign = dot(row(0), c0) < 0 ? -1.f : 1.f;
    return Vec3{dot(c0, n), dot(c1, n), dot(c2, n)} * sign;
  }
  /// Transform into the object's space. Distances along rays are preserved. The fourth lanes are 0.
  struct Inverse {
    Float4 x, y, z;      ///< images of the axes
    Float4 translation;  ///< of the map; subtracted first

    Float4 vector(Float4 v) const { return x * v[0] + y * v[1] + z * v[2]; }
    Float4 point(Float4 p) const { return vector(p - translation); }
    /// Returns a bound of the ratio of the largest coordinates after and before the map, without translation.
    float largest_stretch() const {
      float largest = 0;
      for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(x[i]) + std::abs(y[i]) + std::abs(z[i]));
      return largest;
    }
    /// Transforms a normal from the object's space; not normalized.
    Vec3 normal_from_object(const Vec3& n) const {
      const auto along = [&n](Float4 axis) { return axis[0] * n.x + axis[1] * n.y + axis[2] * n.z; };
      return {along(x), along(y), along(z)};
    }
  };
  /// Inverts by cofactors. The map must be invertible (problem_of).
  Inverse inverse() const {
    const Vec3 x = column(0), y = column(1), z = column(2), yz = cross(y, z), t = translation();
    const float scale = 1 / dot(x, yz);
    const Vec3 a = yz * scale, b = cross(z, x) * scale, c = cross(x, y) * scale;
    return {Float4{a.x, b.x, c.x, 0}, Float4{a.y, b.y, c.y, 0}, Float4{a.z, b.z, c.z, 0}, Float4{t.x, t.y, t.z, 0}};
  }
  /// Returns bounds of the absolute coordinates after the map, and of its intermediate results, of points whose
  /// absolute coordinates are at most `p`.
  Vec3 bound_point(const Vec3& p) const {
    const auto bound = [&p](const std::array<float, 4>& r) {
      return std::abs(r[0]) * p.x + std::abs(r[1]) * p.y + std::abs(r[2]) * p.z + std::abs(r[3]);
    };
    return {bound(rows[0]), bound(rows[1]), bound(rows[2])};
  }
  /// Returns the factor on areas if the map preserves angles up to rounding; else nullopt.
  std::optional<float> area_scale() const {
    const Vec3 x = column(0), y = column(1), z = column(2);
    const float xx = dot(x, x), slack = 1e-4f * xx;
    const auto near = [slack](float a, float b) { return std::abs(a - b) <= slack; };
    if (near(dot(y, y), xx) && near(dot(z, z), xx) && near(dot(x, y), 0) && near(dot(y, z), 0) && near(dot(z, x), 0))
      return xx;
    return {};
  }

 private:
  Vec3 row(size_t i) const { return {rows[i][0], rows[i][1], rows[i][2]}; }
  Vec3 column(size_t j) const { return {rows[0][j], rows[1][j], rows[2][j]}; }
};

/// Returns a map in single precision.
AffineMap rounded_map(const PreciseTransform::Rows& rows);
/// Returns the numbers of a map.
PreciseTransform::Rows precise_rows(const AffineMap& map);

/// Returns the reason why a map is invalid: it has no inverse, or its scale would make ray coordinates overflow or
/// underflow in the object's space; "" if it is valid.
std::string problem_of(const AffineMap& map);

}  // namespace frond
