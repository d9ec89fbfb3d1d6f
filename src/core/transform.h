#pragma once

#include <array>

#include "core/vec.h"

namespace frond {

/// Affine map with its inverse. A map that cannot be inverted holds entries that are not finite: `is_valid` says so,
/// and whoever reads a scene asks it after every step.
class Transform {
 public:
  /// Three rows of four; the last column is the translation, the fourth row would be 0 0 0 1.
  using Rows = std::array<std::array<float, 4>, 3>;
  using RowsDouble = std::array<std::array<double, 4>, 3>;

  Transform() = default;  ///< identity
  /// Invalid when singular.
  explicit Transform(const RowsDouble& rows);

  static Transform translate(const Vec3& by);
  static Transform scale(const Vec3& by);
  /// About an axis of any length but 0, by the right-hand rule.
  static Transform rotate(double angle_deg, const Vec3& axis);
  /// Camera from world: the camera sits at `eye`, +z points at `target`, +y to the side of `up`. The frame is a turned
  /// one, never mirrored: with +x to the right of the image the world is left-handed, as in pbrt. Invalid where the
  /// three give no frame.
  static Transform look_at(const Vec3& eye, const Vec3& target, const Vec3& up);

  /// First `b`, then `a`.
  friend Transform operator*(const Transform& a, const Transform& b);
  friend bool operator==(const Transform&, const Transform&) = default;

  Transform inverse() const { return {inverse_, rows_}; }
  const Rows& rows() const { return rows_; }
  bool is_valid() const;
  /// Mirrors: turns right-handed frames into left-handed ones.
  bool swaps_handedness() const;

  Vec3 point(const Vec3& p) const { return vector(p) + Vec3{rows_[0][3], rows_[1][3], rows_[2][3]}; }
  Vec3 vector(const Vec3& v) const { return {row(rows_[0], v), row(rows_[1], v), row(rows_[2], v)}; }
  /// Keeps normals normal to their surface; the result is not unit.
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
