// PLY meshes: text, and binary in either byte order.

#include "shapes/ply.h"

#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(ply, bytes) {
  PlyMesh ply;
  if (!fuzz::accepts([&] { ply = read_ply_text(bytes, "mesh.ply"); })) return;
  const TriangleMesh& mesh = ply.mesh;
  fuzz::require(mesh.p.size() <= bytes.size() && mesh.triangles.size() + ply.quads.size() <= bytes.size(),
                "a vertex and a face take a byte or more");
  fuzz::require(ply.ignored <= bytes.size(), "an ignored face takes a byte or more");
  fuzz::require(mesh.n.empty() || mesh.n.size() == mesh.p.size(), "each vertex has a normal");
  fuzz::require(mesh.uv.empty() || mesh.uv.size() == mesh.p.size(), "each vertex has texture coordinates");
  for (const auto& triangle : mesh.triangles)
    for (const uint32_t i : triangle) fuzz::require(i < mesh.p.size(), "a triangle's vertices exist");
  for (const auto& quad : ply.quads)
    for (const uint32_t i : quad) fuzz::require(i < mesh.p.size(), "a quadrilateral's vertices exist");
  for (const Vec3& p : mesh.p) fuzz::require_finite(std::array{p.x, p.y, p.z}, "a vertex");
  for (const Vec3& n : mesh.n) fuzz::require_finite(std::array{n.x, n.y, n.z}, "a normal");
  for (const Vec2& uv : mesh.uv) fuzz::require_finite(std::array{uv.x, uv.y}, "a texture coordinate");
}
