#include "scene/geometry/outline.h"

#include <algorithm>
#include <array>

namespace frond {
namespace {

/// Returns the convex hull of points in a plane, by monotone chains (Andrew 1979).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](const Vec2& p) { return std::pair(p.x, p.y); });
  std::vector<Vec2> hull;
  const auto add_chain = [&hull](const auto& chain) {
    const size_t start = hull.size();
    for (const Vec2& p : chain) {
      const auto turns_in = [&] {
        const Vec2 a = hull[hull.size() - 1] - hull[hull.size() - 2], b = p - hull.back();
        return double(a.x) * double(b.y) - double(a.y) * double(b.x) <= 0;
      };
      while (hull.size() >= start + 2 && turns_in()) hull.pop_back();
      hull.push_back(p);
    }
  };
  add_chain(points);
  std::ranges::reverse(points);
  add_chain(points);
  return hull;
}

/// Returns few points whose convex hull contains all points: a prism along the axis of smallest extent, because leaves
/// are flat.
std::vector<Vec3> reduced_outline(const std::vector<Vec3>& points, const Bounds& bounds) {
  constexpr size_t kFew = 16;
  if (points.size() <= kFew) return points;
  const Vec3 size = bounds.max - bounds.min;
  const int z = size.z <= size.x && size.z <= size.y ? 2 : size.y <= size.x ? 1 : 0, x = (z + 1) % 3, y = (z + 2) % 3;
  std::vector<Vec2> flat;
  for (const Vec3& p : points) flat.push_back({p[x], p[y]});
  std::vector<Vec3> around;
  for (const Vec2& corner : convex_hull(std::move(flat)))
    for (const float height : {bounds.min[z], bounds.max[z]}) {
      std::array<float, 3> p{};
      p[size_t(x)] = corner.x, p[size_t(y)] = corner.y, p[size_t(z)] = height;
      around.push_back({p[0], p[1], p[2]});
    }
  return around;
}

}  // namespace

/// Objects with instances of their own use their box.
std::vector<Vec3> outline_of(const ObjectParts& parts, const Bounds& bounds) {
  if (!parts.instances.empty()) return bounds.corners();
  std::vector<Vec3> points;
  for (const Surface& s : parts.surfaces) {
    if (const auto* mesh = std::get_if<MeshPtr>(&s.geometry)) {
      points.insert(points.end(), (*mesh)->p.begin(), (*mesh)->p.end());
    } else {
      const AnalyticShape& shape = *std::get<AnalyticShapePtr>(s.geometry);
      for (unsigned i = 0; i < shape.count(); ++i)
        for (const Vec3& p : shape.outline(i)) points.push_back(p);
    }
  }
  return reduced_outline(points, bounds);
}

}  // namespace frond
