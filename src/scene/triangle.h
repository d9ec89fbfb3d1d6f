#pragma once

#include "core/material.h"
#include "scene/mesh.h"

namespace frond {

/// A point of a mesh's triangle, at barycentrics of its second and third corner.
class Triangle {
 public:
  Triangle(const TriangleMesh& mesh, unsigned primitive, Vec2 b)
      : mesh_(mesh), index_(mesh.triangles[primitive]), b_(b) {}

  Vec3 p() const { return interpolate(mesh_.p); }
  /// Of any length, on the front.
  Vec3 ng() const {
    const Vec3& p0 = mesh_.p[index_[0]];
    return cross(mesh_.p[index_[1]] - p0, mesh_.p[index_[2]] - p0);
  }
  /// Shading normal, of any length.
  Vec3 ns() const { return mesh_.n.empty() ? ng() : interpolate(mesh_.n); }
  /// Without texture coordinates, the corners have (0, 0), (1, 0) and (1, 1), as in pbrt-v4.
  Vec2 uv() const { return mesh_.uv.empty() ? Vec2{b_.x + b_.y, b_.y} : interpolate(mesh_.uv); }
  /// Where (u, v) says nothing of directions on the triangle, some that do.
  SurfaceDerivatives derivatives() const;
  const std::array<uint32_t, 3>& corners() const { return index_; }

 private:
  template <class T>
  T interpolate(const std::vector<T>& values) const {
    return values[index_[0]] * (1 - b_.x - b_.y) + values[index_[1]] * b_.x + values[index_[2]] * b_.y;
  }

  const TriangleMesh& mesh_;
  const std::array<uint32_t, 3>& index_;
  Vec2 b_;
};

}  // namespace frond
