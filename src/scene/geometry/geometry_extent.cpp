#include <set>

#include "scene/geometry/geometry_object.h"

// Materials and extent of the surfaces of a Geometry.

namespace frond {
namespace {

void add_materials(const GeometryObject& object, std::set<const GeometryObject*>& seen, std::set<uint32_t>& materials) {
  if (!seen.insert(&object).second) return;
  for (const Surface& surface : object.parts.surfaces) materials.insert(surface.material);
  for (const GeometryInstances& set : object.instances)
    if (set.instances.table->size() > 0)
      for (const GeometryObject* instanced : set.objects) add_materials(*instanced, seen, materials);
}

}  // namespace

std::vector<uint32_t> Geometry::materials() const {
  std::set<const GeometryObject*> seen;
  std::set<uint32_t> materials;
  add_materials(*world_, seen, materials);
  return {materials.begin(), materials.end()};
}

Bounds Geometry::bounds_of(size_t surface) const {
  Bounds bounds;
  const ShapeGeometry& geometry = surfaces()[surface].geometry;
  if (const auto* mesh = std::get_if<MeshPtr>(&geometry)) {
    for (const Vec3& p : (*mesh)->p) bounds.add(p);
    return bounds;
  }
  const AnalyticShape& shape = *std::get<AnalyticShapePtr>(geometry);
  for (unsigned i = 0; i < shape.count(); ++i) {
    const Bounds b = shape.bounds(i);
    bounds.add(b.min), bounds.add(b.max);
  }
  return bounds;
}

Bounds Geometry::bounds_without(size_t surface) const {
  Bounds bounds;
  const auto add = [&bounds](const Bounds& b) {
    if (!b.is_empty()) bounds.add(b.min), bounds.add(b.max);
  };
  for (size_t i = 0; i < surfaces().size(); ++i)
    if (i != surface) add(bounds_of(i));
  for (const GeometryInstances& set : world_->instances)
    for (size_t row = 0; row < set.instances.table->size(); ++row) {
      const AffineMap map = set.instances.map(row, 0);
      for (const Vec3& corner : set.object(row).outline) {
        const Vec3 p = map.point(corner);
        bounds.add(set.instances.is_placed ? set.instances.placement.point(p) : p);
      }
    }
  return bounds;
}

}  // namespace frond
