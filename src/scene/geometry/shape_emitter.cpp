#include "scene/geometry/shape_emitter.h"

#include "scene/geometry/triangle.h"

namespace frond {
namespace {

/// In double precision, because squares of the edges of very small or large triangles exceed the range of float.
Vec3d edge_cross(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  const Vec3 a = mesh.p[t[1]] - mesh.p[t[0]], b = mesh.p[t[2]] - mesh.p[t[0]];
  return cross(Vec3d{a.x, a.y, a.z}, Vec3d{b.x, b.y, b.z});
}

}  // namespace

/// Triangles of a mesh, or primitives of an analytic shape.
unsigned primitives_of(const ShapeGeometry& geometry) {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry)) return (*shape)->count();
  return unsigned(std::get<MeshPtr>(geometry)->triangles.size());
}

/// Halves of split quadrilaterals are consecutive, from TriangleMesh::halves_from on.
Primitives face_of(const ShapeGeometry& geometry, unsigned primitive) {
  if (const auto* mesh = std::get_if<MeshPtr>(&geometry))
    if (const size_t cut = (*mesh)->halves_from; primitive >= cut) {
      const unsigned first = primitive - unsigned((primitive - cut) % 2);
      return {first, first + 2};
    }
  return {primitive, primitive + 1};
}

unsigned faces_of(const ShapeGeometry& geometry) {
  const unsigned primitives = primitives_of(geometry);
  const auto* mesh = std::get_if<MeshPtr>(&geometry);
  if (!mesh || (*mesh)->halves_from >= primitives) return primitives;
  return primitives - unsigned((primitives - (*mesh)->halves_from) / 2);
}

ShapeEmitter::ShapeEmitter(const Surface& surface) : ShapeEmitter(surface, {0, primitives_of(surface.geometry)}) {}

ShapeEmitter::ShapeEmitter(const Surface& surface, Primitives primitives)
    : geometry_(surface.geometry),
      is_intersectable_(!surface.alpha || surface.alpha->range().max > 0),
      primitives_(primitives) {
  if (is_intersectable_) alpha_ = surface.alpha;
  if (primitives.count() == 1) {
    area_ = area_of(primitives.first);
    return;
  }
  std::vector<float> areas;
  areas.reserve(primitives.count());
  for (unsigned i = primitives.first; i < primitives.end; ++i) areas.push_back(float(area_of(i)));
  by_area_.emplace(areas);
  area_ = by_area_->sum();
}

double ShapeEmitter::area_of(unsigned i) const {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) return (*shape)->area(i);
  const TriangleMesh& mesh = *std::get<MeshPtr>(geometry_);
  return length(edge_cross(mesh, mesh.triangles[i])) / 2;
}

/// Triangles are sampled uniformly by the square-root map.
ShapePoint ShapeEmitter::sample(unsigned primitive, Vec2 u) const {
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) return (*shape)->sample(primitive, u);
  const TriangleMesh& mesh = *std::get<MeshPtr>(geometry_);
  const auto& t = mesh.triangles[primitive];
  const float root = std::sqrt(u.x), b1 = 1 - root, b2 = u.y * root;
  const Vec3 p = mesh.p[t[0]] * (1 - b1 - b2) + mesh.p[t[1]] * b1 + mesh.p[t[2]] * b2;
  const Vec3d n = edge_cross(mesh, t);
  return {p, to_float(normalize_any(n)), {b1, b2}, 0, primitive, length(n) / 2};
}

/// Chooses a primitive by area; the remaining fraction of the random number is reused.
EmittingSurface::Sample ShapeEmitter::sample(Vec2 u) const {
  Sample s;
  double own_area = area_;
  if (!by_area_) {
    s.point = sample(primitives_.first, u);
  } else {
    const auto [index, fraction, probability] = by_area_->sample(u.x);
    s.point = sample(primitives_.first + unsigned(index), {fraction, u.y});
    own_area *= double(probability);
  }
  s.weight = float(s.point.area / own_area);
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_))
    s.uv = (*shape)->uv(s.point.primitive, s.point.at);
  else
    s.uv = Triangle(*std::get<MeshPtr>(geometry_), s.point.primitive, s.point.at).uv();
  return s;
}

/// Bounds of positions and normals, for the light hierarchy.
LightBounds ShapeEmitter::bounds() const {
  Bounds box;
  LightBounds result;
  const auto [first, end] = primitives_;
  if (const auto* shape = std::get_if<AnalyticShapePtr>(&geometry_)) {
    for (unsigned i = first; i < end; ++i) {
      const Bounds one = (*shape)->bounds(i);
      box.add(one.min), box.add(one.max);
    }
  } else {
    const TriangleMesh& mesh = *std::get<MeshPtr>(geometry_);
    const std::span triangles(mesh.triangles.begin() + first, mesh.triangles.begin() + end);
    Vec3d sum;
    for (const auto& t : triangles) {
      for (const uint32_t i : t) box.add(mesh.p[i]);
      sum += edge_cross(mesh, t);
    }
    if (const Vec3d axis = normalize_any(sum); dot(axis, axis) > 0) {
      double least = 1;
      for (const auto& t : triangles) least = std::min(least, dot(axis, normalize_any(edge_cross(mesh, t))));
      result.axis = to_float(axis);
      result.cos_spread = float(std::max(-1.0, least - 0x1p-20));
    }
  }
  result.min = box.min, result.max = box.max;
  return result;
}

}  // namespace frond
