#pragma once

#include <array>

#include "core/math/vec.h"

namespace frond {

/// Affine map in double precision, three rows of a 3 x 4 matrix: of a node to its parent or to the world.
struct NodeMap {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  /// Returns the map of a 4 x 4 matrix that is stored by columns, whose last row is 0 0 0 1.
  template <class T>
  static NodeMap of_columns(const T* columns) {
    NodeMap map;
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 4; ++j) map.m[4 * i + j] = double(columns[4 * j + i]);
    return map;
  }

  Vec3d point(const Vec3d& p) const { return vector(p) + Vec3d{m[3], m[7], m[11]}; }
  Vec3d vector(const Vec3d& v) const {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
            m[8] * v.x + m[9] * v.y + m[10] * v.z};
  }
  /// Transforms a normal by the cofactor matrix, times the sign of the determinant; not normalized.
  Vec3d normal(const Vec3d& n) const {
    const Vec3d a{m[0], m[1], m[2]}, b{m[4], m[5], m[6]}, c{m[8], m[9], m[10]};
    const double sign = determinant() < 0 ? -1 : 1;
    return sign * Vec3d{dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n)};
  }
  double determinant() const {
    return dot(Vec3d{m[0], m[1], m[2]}, cross(Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}));
  }
  /// Returns this map after `first`.
  NodeMap after(const NodeMap& first) const {
    NodeMap map;
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 4; ++j) {
        map.m[4 * i + j] = j == 3 ? m[4 * i + 3] : 0;
        for (size_t k = 0; k < 3; ++k) map.m[4 * i + j] += m[4 * i + k] * first.m[4 * k + j];
      }
    return map;
  }
};

}  // namespace frond
