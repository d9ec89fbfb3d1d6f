#include <algorithm>

#include "core/error.h"
#include "scene/ply.h"
#include "scene/registry.h"
#include "scene/shape.h"

namespace frond {
namespace {

Vec3 face_normal(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  return cross(mesh.p[t[1]] - mesh.p[t[0]], mesh.p[t[2]] - mesh.p[t[0]]);
}

/// As in pbrt: the normals decide which side is the front where a mesh has them, winding and handedness where not, or
/// where they are 0 or lie in the face.
void orient(TriangleMesh& mesh, const ShapePlacement& placement) {
  const bool flip_winding = placement.reverse_orientation != placement.to_scene.swaps_handedness();
  for (auto& t : mesh.triangles) {
    const Vec3 n = mesh.n.empty() ? Vec3{} : mesh.n[t[0]] + mesh.n[t[1]] + mesh.n[t[2]];
    const float agreement = dot(normalize_any(face_normal(mesh, t)), n);
    if (agreement == 0 ? flip_winding : agreement < 0) std::swap(t[1], t[2]);
  }
}

/// Winding counter-clockwise about the front, positions and normals in the scene's space.
MadeShape place(TriangleMesh mesh, const ShapePlacement& placement) {
  for (Vec3& p : mesh.p) p = placement.to_scene.point(p);
  for (Vec3& n : mesh.n) {
    const Vec3 m = normalize_any(placement.to_scene.normal(normalize_any(n)));
    n = placement.reverse_orientation ? -m : m;
  }
  orient(mesh, placement);
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

void check_indices(const Params& p, const std::vector<int>& indices, size_t vertices) {
  if (indices.size() % 3 != 0)
    fail(p.where("indices"), "a triangle mesh takes 3 indices for each triangle, {} given", indices.size());
  for (const int i : indices)
    if (i < 0 || size_t(i) >= vertices)
      fail(p.where("indices"), "index {} is out of range: there are {} vertices", i, vertices);
}

MadeShape make_triangle_mesh(const Params& p, const ShapePlacement& placement) {
  TriangleMesh mesh{.p = p.vec3s("P"), .n = p.vec3s("N"), .uv = p.vec2s("uv"), .triangles = {}};
  auto indices = p.integers("indices");
  if (indices.empty() && mesh.p.size() == 3) indices = {0, 1, 2};
  if (indices.empty()) fail(p.where(), "shape \"trianglemesh\" needs parameter \"integer indices\"");
  check_indices(p, indices, mesh.p.size());
  for (size_t i = 0; i < indices.size(); i += 3)
    mesh.triangles.push_back({uint32_t(indices[i]), uint32_t(indices[i + 1]), uint32_t(indices[i + 2])});
  if (!mesh.n.empty() && mesh.n.size() != mesh.p.size())
    fail(p.where("N"), "{} values of \"N\" for {} of \"P\"", mesh.n.size(), mesh.p.size());
  if (!mesh.uv.empty() && mesh.uv.size() != mesh.p.size())
    fail(p.where("uv"), "{} values of \"uv\" for {} of \"P\"", mesh.uv.size(), mesh.p.size());
  return place(std::move(mesh), placement);
}

MadeShape make_ply_mesh(const Params& p, const ShapePlacement& placement) {
  try {
    return place(read_ply(p.file("filename")), placement);
  } catch (const InputError& error) {
    fail(p.where("filename"), "{}", error.what());
  }
}

constexpr Param kTriangleMesh[] = {
    {.name = "P", .kind = ParamKind::point3, .doc = "Vertices.", .list = true, .required = true},
    {.name = "N",
     .kind = ParamKind::normal3,
     .doc = "Shading normals, one for each vertex; they also decide the front.",
     .list = true},
    {.name = "uv", .kind = ParamKind::point2, .doc = "Texture coordinates, one for each vertex.", .list = true},
    {.name = "indices", .kind = ParamKind::integer, .doc = "Three vertices for each triangle.", .list = true},
    kAlphaParam};
constexpr Param kPlyMesh[] = {{.name = "filename",
                               .kind = ParamKind::string,
                               .doc = "PLY file, ASCII or binary, of triangles and quadrilaterals.",
                               .required = true},
                              kAlphaParam};

}  // namespace

extern const ShapeInfo triangle_mesh_shape{{"shape", "trianglemesh", "Triangles.", "pbrt-v4", kTriangleMesh},
                                           make_triangle_mesh};
extern const ShapeInfo ply_mesh_shape{{"shape", "plymesh", "Triangles from a PLY file.", "pbrt-v4", kPlyMesh},
                                      make_ply_mesh};

}  // namespace frond
