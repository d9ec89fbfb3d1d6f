#pragma once

#include "core/math/precise_transform.h"

namespace frond {

/// Transform of a scene file, in both precisions: rounded after each directive, by which scenes near the origin are
/// placed, and in double precision, by which all others are (scene/origin.h).
struct SceneTransform : Transform {
  PreciseTransform precise;

  SceneTransform() = default;
  SceneTransform(const Transform& single, const PreciseTransform& exact) : Transform(single), precise(exact) {}
  /// A transform in double precision, and its rounded version.
  explicit SceneTransform(const PreciseTransform& exact) : SceneTransform(exact.rounded(), exact) {}

  static SceneTransform translate(const Vec3d& by) {
    return {Transform::translate(to_float(by)), PreciseTransform::translate(by)};
  }
  static SceneTransform scale(const Vec3d& by) { return {Transform::scale(to_float(by)), PreciseTransform::scale(by)}; }
  static SceneTransform rotate(double angle_deg, const Vec3d& axis) {
    return {Transform::rotate(angle_deg, to_float(axis)), PreciseTransform::rotate(angle_deg, axis)};
  }
  static SceneTransform look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
    return {Transform::look_at(to_float(eye), to_float(target), to_float(up)),
            PreciseTransform::look_at(eye, target, up)};
  }
  /// The transform of coordinates that are relative to `origin`, a point of its space, because they would be large.
  SceneTransform relative_to(const Vec3d& origin) const {
    return origin == Vec3d{} ? *this : SceneTransform(precise * PreciseTransform::translate(origin));
  }
  SceneTransform inverse() const { return {Transform::inverse(), precise.inverse()}; }
  friend SceneTransform operator*(const SceneTransform& a, const SceneTransform& b) {
    return {static_cast<const Transform&>(a) * static_cast<const Transform&>(b), a.precise * b.precise};
  }
  friend bool operator==(const SceneTransform& a, const SceneTransform& b) {
    return static_cast<const Transform&>(a) == static_cast<const Transform&>(b) && a.precise.rows() == b.precise.rows();
  }
};

}  // namespace frond
