#pragma once

#include <array>
#include <cmath>
#include <string>

#include "core/ray.h"
#include "core/transform.h"

namespace frond {

/// What places a copy of an object: as a Transform, without its inverse, for there may be very many of them.
struct AffineMap {
  Transform::Rows rows;

  Vec3 translation() const { return {rows[0][3], rows[1][3], rows[2][3]}; }
  Vec3 vector(const Vec3& v) const { return {dot(row(0), v), dot(row(1), v), dot(row(2), v)}; }
  Vec3 point(const Vec3& p) const { return vector(p) + translation(); }
  /// By the cofactors: the inverse transpose up to a positive factor.
  Vec3 normal(const Vec3& n) const {
    const Vec3 c0 = cross(row(1), row(2)), c1 = cross(row(2), row(0)), c2 = cross(row(0), row(1));
    const float sign = dot(row(0), c0) < 0 ? -1.f : 1.f;
    return Vec3{dot(c0, n), dot(c1, n), dot(c2, n)} * sign;
  }
  /// Into the object's own space; distances along rays stay the same.
  struct Inverse {
    std::array<Vec3, 3> rows;
    Vec3 translation;  ///< that of the map, which comes off first

    Vec3 vector(const Vec3& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
    Vec3 point(const Vec3& p) const { return vector(p - translation); }
    Ray ray(const Ray& r) const { return {point(r.o), vector(r.d), r.t_max}; }
  };
  Inverse inverse() const {
    const Vec3 x = column(0), y = column(1), z = column(2), yz = cross(y, z);
    const float scale = 1 / dot(x, yz);
    return {{yz * scale, cross(z, x) * scale, cross(x, y) * scale}, translation()};
  }
  /// Bound of the image's largest coordinate over the point's, without translation.
  float largest_stretch() const {
    float largest = 0;
    for (const auto& r : rows) largest = std::max(largest, std::abs(r[0]) + std::abs(r[1]) + std::abs(r[2]));
    return largest;
  }

 private:
  Vec3 row(size_t i) const { return {rows[i][0], rows[i][1], rows[i][2]}; }
  Vec3 column(size_t j) const { return {rows[0][j], rows[1][j], rows[2][j]}; }
};

/// What is wrong with a map: it has no inverse, or scales so much that a ray's numbers would overflow or vanish in the
/// object's space; "" where nothing is.
std::string problem_of(const AffineMap& map);

}  // namespace frond
