#include <algorithm>
#include <map>

#include "scene/geometry/geometry_object.h"

namespace frond {
namespace {

/// Converts to a Transform, which has an inverse.
Transform transform_of(const AffineMap& map) {
  Transform::RowsDouble rows;
  for (size_t i = 0; i < 3; ++i) std::ranges::copy(map.rows[i], rows[i].begin());
  return Transform(rows);
}

/// Traverses all instances recursively. `first`: number of the object's own surfaces; contained instances follow.
void visit_object(const GeometryObject& object, const Transform& to_world, uint64_t first,
                  const Geometry::SurfaceVisitor& visit) {
  for (const Surface& s : object.parts.surfaces) visit(s, {to_world.rows()}, first);
  for (const GeometryInstances& set : object.instances) {
    const Instances& i = set.instances;
    const Transform placed = i.is_placed ? to_world * transform_of(i.placement) : to_world;
    for (size_t row = 0; row < i.table->size(); ++row) {
      const GeometryObject& instanced = set.object(row);
      const uint64_t id = set.ids.empty() ? set.first_id + row * instanced.ids : set.ids[row];
      visit_object(instanced, placed * transform_of(i.map(row, 0)), first + id, visit);
    }
  }
}

/// Areas of surfaces under maps.
class Areas {
 public:
  /// Returns the area of a transformed surface. If the transform preserves angles, it is the own area times a factor.
  double area(const Surface& surface, const AffineMap& map) {
    if (const auto scale = map.area_scale()) {
      const auto [known, is_new] = own_.try_emplace(&surface, 0);
      if (is_new) known->second = area_under(surface, {Transform().rows()});
      return known->second * double(*scale);
    }
    return area_under(surface, map);
  }

 private:
  /// Sums the areas of transformed triangles, or integrates over an analytic shape.
  static double area_under(const Surface& surface, const AffineMap& map) {
    double sum = 0;
    if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
      for (const auto& [a, b, c] : (*mesh)->triangles) {
        const auto& p = (*mesh)->p;
        sum += double(length(cross(map.vector(p[b] - p[a]), map.vector(p[c] - p[a])))) / 2;
      }
      return sum;
    }
    // Mean factor of the map on areas, over points of the surface; exact for flat surfaces.
    constexpr int kPoints = 64;
    const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
    for (unsigned primitive = 0; primitive < shape.count(); ++primitive)
      for (int i = 0; i < kPoints; ++i) {
        const Vec2 u{(float(i) + 0.5f) / kPoints, float((i * 37) % kPoints) / kPoints};
        const ShapePoint point = shape.sample(primitive, u);
        sum += double(length(map.normal(point.ng))) * point.area / kPoints;
      }
    return sum;
  }

  std::map<const Surface*, double> own_;
};

}  // namespace

void Geometry::visit_surfaces(const SurfaceVisitor& visit) const { visit_object(*world_, Transform(), 0, visit); }

std::vector<float> Geometry::areas() const {
  std::vector<float> areas(instances());
  Areas of_surfaces;
  visit_surfaces([&](const Surface& surface, const AffineMap& to_world, uint64_t instance) {
    if (instance > 0) areas[instance - 1] += float(of_surfaces.area(surface, to_world));
  });
  return areas;
}

}  // namespace frond
