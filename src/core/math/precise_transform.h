#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/transform.h"

namespace frond {

/// Affine transformation with its inverse in double precision: for coordinates that are large beside the distances
/// between them, as map coordinates are. Like a Transform, it has entries that are not finite if it has no inverse.
class PreciseTransform {
 public:
  using Rows = Transform::RowsDouble;

  PreciseTransform() = default;  ///< identity
  explicit PreciseTransform(const Rows& rows);
  /// The entries of `t`. The composition with the inverse is the identity up to double rounding.
  explicit PreciseTransform(const Transform& t);

  static PreciseTransform translate(const Vec3d& by);
  static PreciseTransform scale(const Vec3d& by);
  /// As Transform::rotate and Transform::look_at.
  static PreciseTransform rotate(double angle_deg, const Vec3d& axis);
  static PreciseTransform look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up);

  /// Applies `b` first, then `a`.
  friend PreciseTransform operator*(const PreciseTransform& a, const PreciseTransform& b);

  PreciseTransform inverse() const { return {inverse_, rows_}; }
  const Rows& rows() const { return rows_; }
  /// The same in single precision.
  Transform rounded() const { return Transform(rows_); }

  Vec3d point(const Vec3d& p) const { return point(rows_, p); }
  Vec3d vector(const Vec3d& v) const { return vector(rows_, v); }
  Vec3d inverse_point(const Vec3d& p) const { return vector(inverse_, p - translation()); }
  Vec3d inverse_vector(const Vec3d& v) const { return vector(inverse_, v); }

 private:
  PreciseTransform(const Rows& rows, const Rows& inverse) : rows_(rows), inverse_(inverse) {}
  Vec3d translation() const { return {rows_[0][3], rows_[1][3], rows_[2][3]}; }
  static Vec3d vector(const Rows& m, const Vec3d& v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
  }
  static Vec3d point(const Rows& m, const Vec3d& p) { return vector(m, p) + Vec3d{m[0][3], m[1][3], m[2][3]}; }

  static constexpr Rows kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  Rows rows_ = kIdentity, inverse_ = kIdentity;
};

/// Column `j` of a matrix: an axis, or with 3 the translation.
inline Vec3d column(const Transform::RowsDouble& m, size_t j) { return {m[0][j], m[1][j], m[2][j]}; }
/// The same entries in double precision.
Transform::RowsDouble to_double(const Transform::Rows& m);
/// The matrix that applies `b` first, then `a`.
Transform::RowsDouble multiply(const Transform::RowsDouble& a, const Transform::RowsDouble& b);

/// Largest absolute value of the coordinates.
inline double largest_coordinate(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Coordinates beyond this are far: 32-bit floats have steps of 2^-15 there, and rays that leave a surface start 2 mm
/// above it (offset_origin) if the unit is a metre. A scene of leaves with a radius of 0.08 has a bias of 4e-5 there.
inline constexpr double kFar = 256;
inline bool is_far(const Vec3d& p) { return largest_coordinate(p) > kFar; }
/// Distance of neighbouring 32-bit floats at `x`.
inline double float_spacing(double x) { return std::ldexp(1.0, std::ilogb(x) - 23); }

}  // namespace frond
