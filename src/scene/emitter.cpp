#include "scene/emitter.h"

namespace frond {
namespace {

Vec3 edge_cross(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  return cross(mesh.p[t[1]] - mesh.p[t[0]], mesh.p[t[2]] - mesh.p[t[0]]);
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
  for (const auto& t : mesh.triangles) areas.push_back(length(edge_cross(mesh, t)) / 2);
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
  return {p, normalize(edge_cross(mesh, t)), {}, 0};
}

}  // namespace frond
