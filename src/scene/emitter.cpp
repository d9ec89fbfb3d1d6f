#include "scene/emitter.h"

#include "scene/triangle.h"

namespace frond {
namespace {

/// In double: the squares of what small and large triangles give do not fit into floats.
Vec3d edge_cross(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  const Vec3 a = mesh.p[t[1]] - mesh.p[t[0]], b = mesh.p[t[2]] - mesh.p[t[0]];
  return cross(Vec3d{a.x, a.y, a.z}, Vec3d{b.x, b.y, b.z});
}

}  // namespace

EmittingSurface::EmittingSurface(const ShapeGeometry& geometry) : geometry_(geometry) {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) {
    area_ = (*shape)->area();
    return;
  }
  const TriangleMesh& mesh = *std::get<MeshPtr>(geometry_);
  std::vector<float> areas;
  areas.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) areas.push_back(float(length(edge_cross(mesh, t)) / 2));
  triangles_by_area_.emplace(areas);
  area_ = triangles_by_area_->sum();
}

ShapePoint EmittingSurface::sample(Vec2 u) const {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) return (*shape)->sample(u);
  const TriangleMesh& mesh = *std::get<MeshPtr>(geometry_);
  const auto [index, fraction, pdf] = triangles_by_area_->sample(u.x);
  const auto& t = mesh.triangles[index];
  const float root = std::sqrt(fraction), b1 = 1 - root, b2 = u.y * root;
  const Vec3 p = mesh.p[t[0]] * (1 - b1 - b2) + mesh.p[t[1]] * b1 + mesh.p[t[2]] * b2;
  const Vec3d n = normalize_any(edge_cross(mesh, t));
  return {p, to_float(n), {b1, b2}, 0, unsigned(index)};
}

Vec2 EmittingSurface::uv(const ShapePoint& point) const {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) return (*shape)->uv(point.primitive, point.at);
  return Triangle(*std::get<MeshPtr>(geometry_), point.primitive, point.at).uv();
}

LightBounds EmittingSurface::bounds() const {
  Bounds box;
  LightBounds result;
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) {
    for (unsigned i = 0; i < (*shape)->count(); ++i) {
      const Bounds one = (*shape)->bounds(i);
      box.add(one.min), box.add(one.max);
    }
  } else {
    const TriangleMesh& mesh = *std::get<MeshPtr>(geometry_);
    Vec3d sum;
    for (const auto& t : mesh.triangles) {
      for (const uint32_t i : t) box.add(mesh.p[i]);
      sum += edge_cross(mesh, t);
    }
    if (const Vec3d axis = normalize_any(sum); dot(axis, axis) > 0) {
      double least = 1;
      for (const auto& t : mesh.triangles) least = std::min(least, dot(axis, normalize_any(edge_cross(mesh, t))));
      result.axis = to_float(axis);
      result.cos_spread = float(std::max(-1.0, least - 0x1p-20));
    }
  }
  result.min = box.min, result.max = box.max;
  return result;
}

}  // namespace frond
