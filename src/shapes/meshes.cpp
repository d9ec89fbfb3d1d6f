#include <algorithm>

#include "core/error.h"
#include "core/math/affine_map.h"
#include "core/messages/counted.h"
#include "core/shape.h"
#include "shapes/bilinear.h"
#include "shapes/ply.h"
#include "shapes/subdivision.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

/// Transforms vertices and normals to world space.
void place_corners(std::vector<Vec3>& p, std::vector<Vec3>& n, const ShapePlacement& placement) {
  for (Vec3& at : p) at = placement.to_scene.point(at);
  place_normals(n, placement);
}

/// Winding is counter-clockwise seen from the front; positions and normals are in world space.
ShapeGeometry oriented(TriangleMesh mesh, const ShapePlacement& placement) {
  orient_mesh(mesh, placement);
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Whether both paths from a quadrilateral's first corner to its third have the same sum: bilinear interpolation is
/// then linear.
template <class T>
bool is_linear(const std::array<T, 4>& q, float slack) {
  const T twist = q[0] - q[1] + q[2] - q[3];
  const T sides = q[2] - q[0];
  if constexpr (std::is_same_v<T, Vec2>)
    return std::max(std::abs(twist.x), std::abs(twist.y)) <= slack * std::max(std::abs(sides.x), std::abs(sides.y));
  else
    return length(twist) <= slack * std::max(length(sides), length(q[3] - q[1]));
}

/// Whether the patch is a parallelogram with linear attributes: two triangles then give the same image and are faster.
bool is_flat(const TriangleMesh& mesh, const std::array<uint32_t, 4>& quad) {
  const auto four = [&quad](const auto& values) {
    return std::array{values[quad[0]], values[quad[1]], values[quad[2]], values[quad[3]]};
  };
  return is_linear(four(mesh.p), 1e-5f) && (mesh.uv.empty() || is_linear(four(mesh.uv), 1e-4f)) &&
         (mesh.n.empty() || length(four(mesh.n)[0] - four(mesh.n)[1] + four(mesh.n)[2] - four(mesh.n)[3]) <= 1e-4f);
}

/// Returns triangles, and bilinear patches for quadrilaterals as in pbrt-v4.
std::vector<ShapeGeometry> surfaces_of(PlyMesh file, const ShapePlacement& placement) {
  TriangleMesh& mesh = file.mesh;
  place_corners(mesh.p, mesh.n, placement);
  PatchMesh twisted;
  mesh.halves_from = mesh.triangles.size();
  for (const auto& [a, b, c, d] : file.quads) {
    if (is_flat(mesh, {a, b, c, d})) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    } else {
      twisted.patches.push_back({a, b, d, c});
    }
  }
  std::vector<ShapeGeometry> surfaces;
  if (!twisted.patches.empty()) {
    const bool is_all = mesh.triangles.empty();
    twisted.p = is_all ? std::move(mesh.p) : mesh.p;
    twisted.n = is_all ? std::move(mesh.n) : mesh.n;
    twisted.uv = is_all ? std::move(mesh.uv) : mesh.uv;
    surfaces.push_back(patches(std::move(twisted), placement));
  }
  if (!mesh.triangles.empty()) surfaces.push_back(oriented(std::move(mesh), placement));
  return surfaces;
}

/// Throws InputError for an incomplete triangle or an index out of range.
void check_indices(const Params& p, const std::vector<int>& indices, size_t vertices) {
  if (indices.size() % 3 != 0)
    fail(p.where("indices"), "a triangle mesh takes 3 indices for each triangle, {} given", indices.size());
  for (const int i : indices)
    if (i < 0 || size_t(i) >= vertices)
      fail(p.where("indices"), "index {} is out of range: there are {} vertices", i, vertices);
}

/// Three vertices without indices are a single triangle, as in pbrt-v4.
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
  // Reads parameters that have no effect, so that they are not reported as unknown.
  p.vec3s("S"), p.integers("faceIndices");
  place_corners(mesh.p, mesh.n, placement);
  return std::vector{oriented(std::move(mesh), placement)};
}

/// Warns if a file has rounded its vertices: to steps that a leaf's shape shows.
void warn_of_steps(const Params& p, const PlyMesh& file) {
  // In scene units, and as a share of the largest extent.
  constexpr double kLargest = 1. / 256, kLargestShare = 1. / 2048;
  if (file.step == 0) return;
  Bounds bounds;
  for (const Vec3& at : file.mesh.p) bounds.add(at);
  const Vec3 size = bounds.max - bounds.min;
  if (file.step < kLargest && file.step < kLargestShare * double(largest_coordinate(size))) return;
  p.warn("filename",
         fmt::format("its vertices are 32-bit floats up to {:.3g} units from the origin, where their step is "
                     "{:g} units; \"property double x\" (y, z) keeps such coordinates",
                     file.step * (1 << 23), file.step));
}

/// Errors in the file are reported at the parameter that names it.
MadeShape make_ply_mesh(const Params& p, const ShapePlacement& placement) {
  const std::filesystem::path path = p.file("filename");
  const std::string bytes = read_file_bytes(path, p.where("filename"));
  try {
    const std::vector<double> origin = p.reals("origin");
    PlyMesh file = read_ply_bytes(bytes, path.string(), {origin[0], origin[1], origin[2]});
    warn_of_steps(p, file);
    if (file.ignored > 0)
      p.warn("filename", fmt::format("{} left out, as in pbrt-v4",
                                     counted(file.ignored, "face is neither triangle nor quadrilateral and is",
                                             "faces are neither triangles nor quadrilaterals and are")));
    if (!file.unused.empty()) p.warn("filename", fmt::format("the file has data that are not used: {}", file.unused));
    return surfaces_of(std::move(file), placement);
  } catch (const InputError& error) {
    fail(p.where("filename"), "{}", error.what());
  }
}

/// Loop subdivision of a triangle mesh to its limit surface.
MadeShape make_loop_subdivision(const Params& p, const ShapePlacement& placement) {
  const std::vector<Vec3> cage = p.vec3s("P");
  const std::vector<int> indices = p.integers("indices");
  if (indices.empty()) fail(p.where("indices"), "shape \"loopsubdiv\" needs a triangle at least");
  check_indices(p, indices, cage.size());
  std::vector<std::array<uint32_t, 3>> faces;
  for (size_t i = 0; i < indices.size(); i += 3)
    faces.push_back({uint32_t(indices[i]), uint32_t(indices[i + 1]), uint32_t(indices[i + 2])});
  p.string("scheme");
  const int levels = p.integer("levels");
  constexpr double kMostTriangles = 20e6, kBytesEach = 150;  // bytes for each triangle, measured, including Embree's
  if (const double count = double(faces.size()) * std::pow(4.0, levels); count > kMostTriangles)
    fail(p.where("levels"), "{} levels make {:.3g} triangles, of some {:.0f} GB: {:.0f} million are the limit", levels,
         count, std::ceil(count * kBytesEach / 1e9), kMostTriangles / 1e6);
  TriangleMesh mesh;
  if (const std::string problem = subdivide(cage, faces, levels, mesh); !problem.empty())
    fail(p.where("indices"), "{}", problem);
  place_corners(mesh.p, mesh.n, placement);
  return std::vector{oriented(std::move(mesh), placement)};
}

constexpr Param kTriangleMesh[] = {
    {.name = "P", .kind = ParamKind::point3, .doc = "Vertices.", .list = true, .required = true},
    {.name = "N",
     .kind = ParamKind::normal3,
     .doc = "Shading normals, one for each vertex; they also determine the front.",
     .list = true},
    {.name = "uv", .kind = ParamKind::point2, .doc = "Texture coordinates, one for each vertex.", .list = true},
    {.name = "indices", .kind = ParamKind::integer, .doc = "Vertex indices, three for each triangle.", .list = true},
    {.name = "S", .kind = ParamKind::vector3, .doc = "Accepted for compatibility with pbrt-v4; ignored.", .list = true},
    {.name = "faceIndices",
     .kind = ParamKind::integer,
     .doc = "Accepted for compatibility with pbrt-v4; ignored.",
     .list = true},
    kAlphaParam};
constexpr Param kPlyMesh[] = {
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "PLY file, ASCII or binary, of triangles and quadrilaterals, which become "
            "bilinear patches; .ply.gz: compressed.",
     .required = true},
    {.name = "origin",
     .kind = ParamKind::point3,
     .default_value = std::array<double, 3>{0, 0, 0},
     .doc = "Point that is subtracted from the file's vertices, before they are rounded to 32 "
            "bits and transformed: for files in map coordinates."},
    kAlphaParam};
constexpr Param kLoopSubdivision[] = {
    {.name = "P", .kind = ParamKind::point3, .doc = "Vertices of the control mesh.", .list = true, .required = true},
    {.name = "indices",
     .kind = ParamKind::integer,
     .doc = "Vertex indices, three for each triangle.",
     .list = true,
     .required = true},
    {.name = "levels",
     .kind = ParamKind::integer,
     .default_value = 3,
     .range = {0, 12},
     .doc = "Number of subdivisions, each into four triangles; vertices are then moved to the limit surface."},
    {.name = "scheme",
     .kind = ParamKind::string,
     .default_value = std::string_view("loop"),
     .doc = "Accepted for compatibility with pbrt-v4; ignored: the scheme is Loop's."},
    kAlphaParam};

}  // namespace

extern const ShapeInfo triangle_mesh_shape{{"shape", "trianglemesh", "Triangle mesh.", "pbrt-v4", kTriangleMesh},
                                           make_triangle_mesh};
extern const ShapeInfo ply_mesh_shape{
    {"shape", "plymesh", "Triangles and bilinear patches from a PLY file.", "pbrt-v4", kPlyMesh}, make_ply_mesh};
extern const ShapeInfo loop_subdivision_shape{
    {"shape", "loopsubdiv", "Limit surface of Loop subdivision.", "pbrt-v4", kLoopSubdivision}, make_loop_subdivision};

}  // namespace frond
