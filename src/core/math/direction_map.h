#pragma once

#include "core/math/affine_map.h"

namespace frond {

/// Maps directions between world space and a light's space, in which its image is defined. A map that is not a rotation
/// changes densities over solid angle.
class DirectionMap {
 public:
  explicit DirectionMap(const Transform& world_from_light)
      : world_from_light_(world_from_light),
        light_from_world_(world_from_light.inverse()),
        is_rotation_(AffineMap{world_from_light.rows()}.area_scale().has_value()) {
    const AffineMap map{world_from_light.rows()};
    const Vec3 x = map.vector({1, 0, 0}), y = map.vector({0, 1, 0}), z = map.vector({0, 0, 1});
    volume_ = std::abs(dot(cross(x, y), z));
  }

  /// Whether the map preserves angles; reflections and scales are allowed.
  bool is_rotation() const { return is_rotation_; }
  /// Returns a unit vector.
  Vec3 to_world(const Vec3& w) const { return normalize_any(world_from_light_.vector(w)); }
  Vec3 to_light(const Vec3& w) const { return normalize_any(light_from_world_.vector(w)); }
  /// Returns the factor on solid angles around a unit direction of the light's space: the determinant over the cubed
  /// stretch of the direction.
  float solid_angle_factor(const Vec3& w) const {
    if (is_rotation_) return 1;
    const float stretch = length(world_from_light_.vector(w));
    return volume_ / (stretch * stretch * stretch);
  }

 private:
  Transform world_from_light_, light_from_world_;
  bool is_rotation_;
  float volume_;
};

}  // namespace frond
