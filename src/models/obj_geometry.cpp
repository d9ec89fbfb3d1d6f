#include "models/obj_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/math/precise_transform.h"
#include "models/polygon.h"

namespace frond {
namespace {

/// Returns the middle value, and sorts in part. There is at least one.
double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Divides the faces. Their corners may follow them in the file, so that this is done at its end.
void add_triangles(const ObjFaces& faces, ImportedMesh& mesh) {
  const uint32_t* corner = faces.corners.data();
  std::vector<Vec3d> points;
  for (const uint32_t size : faces.sizes) {
    points.clear();
    for (uint32_t k = 0; k < size; ++k) points.push_back(to_double(mesh.positions[corner[k]]));
    for (const auto& [a, b, c] : triangulated(points)) mesh.triangles.push_back({corner[a], corner[b], corner[c]});
    corner += size;
  }
}

}  // namespace

std::array<double, 3> obj_origin(const std::vector<std::array<double, 3>>& vertices) {
  constexpr double kFewNear = 0.01;
  const auto far = [](const std::array<double, 3>& p) { return is_far({p[0], p[1], p[2]}); };
  const auto near = vertices.size() - size_t(std::ranges::count_if(vertices, far));
  if (vertices.empty() || double(near) >= kFewNear * double(vertices.size())) return {};
  std::array<double, 3> origin{};
  for (size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values(vertices.size());
    for (size_t i = 0; i < values.size(); ++i) values[i] = vertices[i][axis];
    origin[axis] = std::round(median(std::move(values)));
  }
  return far(origin) ? origin : std::array<double, 3>{};
}

void add_geometry(const ObjFaces& faces, const ObjElements& elements, bool has_uv, bool has_normal,
                  const ImportedScene& scene, ImportedMesh& mesh) {
  const auto& m = scene.materials[mesh.material].uv_texture().to_image;
  for (const ObjCorner& c : faces.vertices) {
    const auto& p = elements[kVertex][c[kVertex] - 1];
    mesh.positions.push_back(
        {float(p[0] - scene.origin[0]), float(p[1] - scene.origin[1]), float(p[2] - scene.origin[2])});
    if (has_uv) {
      const auto& uv = elements[kTexture][c[kTexture] - 1];
      mesh.uvs.push_back({float(double(m[0]) * uv[0] + double(m[2])), float(double(m[4]) * uv[1] + double(m[5]))});
    }
    if (!has_normal) continue;
    const auto& n = elements[kNormal][c[kNormal] - 1];
    mesh.normals.push_back({float(n[0]), float(n[1]), float(n[2])});
  }
  add_triangles(faces, mesh);
}

}  // namespace frond
