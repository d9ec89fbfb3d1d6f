#include "scene/shape.h"

#include <algorithm>

namespace frond {

void Bounds::add(const Vec3& p) {
  min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
  max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

std::vector<Vec3> Bounds::corners() const {
  std::vector<Vec3> points;
  if (is_empty()) return points;
  for (const float x : {min.x, max.x})
    for (const float y : {min.y, max.y})
      for (const float z : {min.z, max.z}) points.push_back({x, y, z});
  return points;
}

void place_normals(std::vector<Vec3>& normals, const ShapePlacement& placement) {
  for (Vec3& n : normals) {
    const Vec3 m = normalize_any(placement.to_scene.normal(normalize_any(n)));
    n = placement.reverse_orientation ? -m : m;
  }
}

}  // namespace frond
