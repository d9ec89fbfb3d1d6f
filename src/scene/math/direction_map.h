#pragma once

#include "scene/math/affine_map.h"

namespace frond {

/// Directions of a light's own space, which an image is given over, in the world and back. A map that is no rotation
/// crowds them together or spreads them, so densities over solid angles change too.
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

  /// Or mirrors; lengths do not matter.
  bool is_rotation() const { return is_rotation_; }
  /// Unit.
  Vec3 to_world(const Vec3& w) const { return normalize_any(world_from_light_.vector(w)); }
  Vec3 to_light(const Vec3& w) const { return normalize_any(light_from_world_.vector(w)); }
  /// By how much solid angles around a unit direction of the light's space grow: of a cone's base only what lies
  /// across the image of its axis counts, and at that one's distance.
  float spread(const Vec3& w) const {
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
