#include <algorithm>
#include <map>

#include "scene/geometry/geometry_object.h"

namespace frond {
namespace {

/// Traverses all instances recursively.
class Areas {
 public:
  explicit Areas(std::vector<float>& areas) : areas_(areas) {}

  /// `first`: number of the object's own surfaces; contained instances follow.
  void visit(const GeometryObject& object, const Transform& to_world, uint64_t first) {
    if (first > 0)
      for (const Surface& s : object.parts.surfaces) areas_[first - 1] += float(area(s, to_world));
    for (const GeometryInstances& set : object.instances) {
      const Instances& i = set.instances;
      const Transform placed = i.is_placed ? to_world * transform_of(i.placement) : to_world;
      for (size_t row = 0; row < i.table->size(); ++row) {
        const GeometryObject& instanced = set.object(row);
        const uint64_t id = set.ids.empty() ? set.first_id + row * instanced.ids : set.ids[row];
        visit(instanced, placed * transform_of(i.map(row, 0)), first + id);
      }
    }
  }

 private:
  /// Converts to a Transform, which has an inverse.
  static Transform transform_of(const AffineMap& map) {
    Transform::RowsDouble rows;
    for (size_t i = 0; i < 3; ++i) std::ranges::copy(map.rows[i], rows[i].begin());
    return Transform(rows);
  }

  /// Returns the area of a transformed surface. If the transform preserves angles, it is the own area times a factor.
  double area(const Surface& surface, const Transform& t) {
    if (const auto scale = AffineMap{t.rows()}.area_scale()) {
      const auto [known, is_new] = own_.try_emplace(&surface, 0);
      if (is_new) known->second = area_under(surface, Transform());
      return known->second * double(*scale);
    }
    return area_under(surface, t);
  }

  /// Sums the areas of transformed triangles, or integrates over an analytic shape.
  static double area_under(const Surface& surface, const Transform& t) {
    double sum = 0;
    if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
      for (const auto& [a, b, c] : (*mesh)->triangles) {
        const auto& p = (*mesh)->p;
        sum += double(length(cross(t.vector(p[b] - p[a]), t.vector(p[c] - p[a])))) / 2;
      }
      return sum;
    }
    // Mean factor of the map on areas, over points of the surface; exact for flat surfaces.
    constexpr int kPoints = 64;
    const AnalyticShape& shape = *std::get<AnalyticShapePtr>(surface.geometry);
    const AffineMap map{t.rows()};
    for (unsigned primitive = 0; primitive < shape.count(); ++primitive)
      for (int i = 0; i < kPoints; ++i) {
        const Vec2 u{(float(i) + 0.5f) / kPoints, float((i * 37) % kPoints) / kPoints};
        const ShapePoint point = shape.sample(primitive, u);
        sum += double(length(map.normal(point.ng))) * point.area / kPoints;
      }
    return sum;
  }

  std::vector<float>& areas_;
  std::map<const Surface*, double> own_;
};

}  // namespace

/// Traverses the whole scene once.
std::vector<float> Geometry::areas() const {
  std::vector<float> areas(instances());
  Areas(areas).visit(*world_, Transform(), 0);
  return areas;
}

}  // namespace frond
