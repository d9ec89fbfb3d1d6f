#include <cmath>
#include <numbers>

#include "core/plugin_module.h"

namespace blade {
namespace {

using namespace frond;

constexpr Param kParams[] = {
    {.name = "length", .kind = ParamKind::real, .default_value = 1, .range = {1e-6, 1e6}, .doc = "Along the midrib."},
    {.name = "width", .kind = ParamKind::real, .default_value = 0.1, .range = {1e-6, 1e6}, .doc = "At the base."},
    {.name = "bend",
     .kind = ParamKind::real,
     .default_value = 60,
     .unit = "degrees",
     .range = {0, 360},
     .doc = "How far the midrib turns from the base to the tip."},
    {.name = "segments", .kind = ParamKind::integer, .default_value = 12, .range = {1, 1000}, .doc = "Along the midrib."},
    kAlphaParam};

/// A blade of grass: it leaves the origin along +z, its midrib bends toward +y along an arc of a circle, and it narrows as
/// a parabola to its tip. The front, which faces -y at the base, is the outside of the bend. (u, v): across and along.
MadeShape make_blade(const Params& p, const ShapePlacement& placement) {
  const double length = p.real("length"), bend = p.real("bend") * std::numbers::pi / 180;
  const int segments = p.integer("segments");
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i <= segments; ++i) {
    const double v = double(i) / segments, angle = bend * v;
    const double y = bend > 0 ? length / bend * (1 - std::cos(angle)) : 0,
                 z = bend > 0 ? length / bend * std::sin(angle) : length * v;
    const double half = p.real("width") / 2 * (1 - v * v);
    for (const double side : {-1.0, 1.0}) {
      mesh->p.push_back(placement.to_scene.point({float(side * half), float(y), float(z)}));
      mesh->n.push_back({0, float(-std::cos(angle)), float(std::sin(angle))});
      mesh->uv.push_back({float((1 + side) / 2), float(v)});
    }
  }
  place_normals(mesh->n, placement);
  for (uint32_t a = 0; a < 2 * uint32_t(segments); a += 2) {
    mesh->triangles.push_back({a, a + 1, a + 3});
    if (a + 2 < 2 * uint32_t(segments)) mesh->triangles.push_back({a, a + 3, a + 2});  // the last one ends in the tip
  }
  orient_mesh(*mesh, placement);
  return std::vector<ShapeGeometry>{MeshPtr(mesh)};
}

const ShapeInfo kBlade{{"shape", "blade", "A blade of grass.", "", kParams}, make_blade};
const ShapeInfo* const kShapes[] = {&kBlade};

}  // namespace
}  // namespace blade

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.shapes = blade::kShapes};
  return &module;
}
