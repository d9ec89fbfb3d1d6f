#pragma once

#include <array>

#include "core/math/vec.h"

namespace frond {

/// Affine transformation with its inverse. A transformation that cannot be inverted has entries that are not finite;
/// the scene reader calls `is_valid` after every directive that changes one.
class Transform {
 public:
  /// The first three rows of a 4 x 4 matrix, whose last column is the translation; the fourth row is 0 0 0 1.
  using Rows = std::array<std::array<float, 4>, 3>;
  using RowsDouble = std::array<std::array<double, 4>, 3>;

  Transform() = default;  ///< identity
  /// Invalid if `rows` is singular.
  explicit Transform(const RowsDouble& rows);

  static Transform translate(const Vec3& by);
  static Transform scale(const Vec3& by);
  /// Rotation by `angle_deg` degrees about `axis`, of any length but 0, by the right-hand rule.
  static Transform rotate(double angle_deg, const Vec3& axis);
  /// Camera-from-world transformation of a camera at `eye` whose +z axis points to `target`, with +y in the plane of z
  /// and `up`. It is a rotation and a translation, without reflection: if +x points to the right of the image, the
  /// world is left-handed, as in pbrt. Invalid if `target` equals `eye` or `up` is parallel to the viewing direction.
  static Transform look_at(const Vec3& eye, const Vec3& target, const Vec3& up);

  /// Applies `b` first, then `a`.
  friend Transform operator*(const Transform& a, const Transform& b);
  friend bool operator==(const Transform&, const Transform&) = default;

  Transform inverse() const { return {inverse_, rows_}; }
  const Rows& rows() const { return rows_; }
  /// True if all entries of the matrix and of its inverse are finite.
  bool is_valid() const;
  /// True if the transformation maps right-handed frames to left-handed ones (negative determinant).
  bool swaps_handedness() const;

  Vec3 point(const Vec3& p) const { return vector(p) + Vec3{rows_[0][3], rows_[1][3], rows_[2][3]}; }
  Vec3 vector(const Vec3& v) const { return {row(rows_[0], v), row(rows_[1], v), row(rows_[2], v)}; }
  /// Transforms a surface normal by the inverse transpose. The result is not normalized.
  Vec3 normal(const Vec3& n) const {
    const Rows& i = inverse_;
    return {i[0][0] * n.x + i[1][0] * n.y + i[2][0] * n.z, i[0][1] * n.x + i[1][1] * n.y + i[2][1] * n.z,
            i[0][2] * n.x + i[1][2] * n.y + i[2][2] * n.z};
  }

 private:
  Transform(const Rows& rows, const Rows& inverse) : rows_(rows), inverse_(inverse) {}
  static float row(const std::array<float, 4>& r, const Vec3& v) { return r[0] * v.x + r[1] * v.y + r[2] * v.z; }

  static constexpr Rows kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  Rows rows_ = kIdentity, inverse_ = kIdentity;
};

}  // namespace frond
