#pragma once

#include <algorithm>
#include <cmath>

#include "core/material.h"
#include "core/shape.h"

namespace frond {

/// A point on a triangle of a mesh, given by the barycentrics of the second and third corner.
class Triangle {
 public:
  Triangle(const TriangleMesh& mesh, unsigned primitive, Vec2 b)
      : mesh_(mesh), index_(mesh.triangles[primitive]), primitive_(primitive), b_(b) {}

  Vec3 p() const { return interpolate(mesh_.p); }
  /// Geometric normal of the front, not normalized.
  Vec3 ng() const {
    const Vec3& p0 = mesh_.p[index_[0]];
    return cross(mesh_.p[index_[1]] - p0, mesh_.p[index_[2]] - p0);
  }
  /// Shading normal, not normalized.
  Vec3 ns() const { return mesh_.n.empty() ? ng() : interpolate(mesh_.n); }
  /// Texture coordinates. Without any, the corners have (0, 0), (1, 0) and (1, 1), and quadrilaterals also (0, 1), as
  /// in pbrt-v4.
  Vec2 uv() const {
    if (!mesh_.uv.empty()) return interpolate(mesh_.uv);
    const auto [s, t] = default_sides();
    return s * b_.x + t * b_.y;
  }
  /// Returns derivatives by (u, v), or arbitrary tangents if (u, v) is degenerate.
  SurfaceDerivatives derivatives() const;
  /// Largest absolute value of each coordinate of the corners.
  Vec3 extent() const {
    const Vec3 &a = mesh_.p[index_[0]], &b = mesh_.p[index_[1]], &c = mesh_.p[index_[2]];
    const auto largest = [](float x, float y, float z) { return std::max({std::abs(x), std::abs(y), std::abs(z)}); };
    return {largest(a.x, b.x, c.x), largest(a.y, b.y, c.y), largest(a.z, b.z, c.z)};
  }

 private:
  /// Default texture coordinates of the second and third corner; the first has (0, 0).
  std::array<Vec2, 2> default_sides() const {
    const bool is_second_half = primitive_ >= mesh_.halves_from && ((primitive_ - mesh_.halves_from) & 1);
    const Vec2 s = is_second_half ? Vec2{1, 1} : Vec2{1, 0}, t = is_second_half ? Vec2{0, 1} : Vec2{1, 1};
    if (!mesh_.flipped.empty() && mesh_.flipped[primitive_]) return {t, s};
    return {s, t};
  }

  template <class T>
  T interpolate(const std::vector<T>& values) const {
    return values[index_[0]] * (1 - b_.x - b_.y) + values[index_[1]] * b_.x + values[index_[2]] * b_.y;
  }

  const TriangleMesh& mesh_;
  const std::array<uint32_t, 3>& index_;
  unsigned primitive_;
  Vec2 b_;
};

}  // namespace frond
