#include "models/normal_map_sides.h"

#include <algorithm>

#include "core/math/vec.h"

namespace frond {
namespace {

/// Twice the area of a triangle in texture coordinates, below 0 if their orientation is the opposite of the vertices',
/// and the direction of u, with any length.
struct Direction {
  double area;
  Vec3d u;
};
Direction direction_of(const ImportedMesh& mesh, const std::array<uint32_t, 3>& t) {
  const auto uv = [&](size_t corner, size_t axis) {
    return double(mesh.uvs[t[corner]][axis]) - double(mesh.uvs[t[0]][axis]);
  };
  const auto edge = [&](size_t corner) {
    return to_double(mesh.positions[t[corner]]) - to_double(mesh.positions[t[0]]);
  };
  const double area = uv(1, 0) * uv(2, 1) - uv(2, 0) * uv(1, 1);
  return {area, (area < 0 ? -1. : 1.) * (uv(2, 1) * edge(1) - uv(1, 1) * edge(2))};
}

/// Returns the index of the material with the y axis of its normal map inverted.
uint32_t inverted(uint32_t material, ImportedScene& scene) {
  ImportedMaterial other = scene.materials[material];
  other.normal_scale[1] = -other.normal_scale[1];
  return scene.add(std::move(other));
}

/// Removes the vertices that no triangle has: primitives may share one array of vertices.
void remove_unused(ImportedMesh& mesh) {
  std::vector<uint32_t> index(mesh.positions.size());
  for (const auto& t : mesh.triangles)
    for (const uint32_t i : t) index[i] = 1;
  uint32_t count = 0;
  for (size_t i = 0; i < index.size(); ++i) {
    if (index[i] == 0) continue;
    mesh.positions[count] = mesh.positions[i];
    if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
    if (!mesh.uvs.empty()) mesh.uvs[count] = mesh.uvs[i];
    index[i] = count++;
  }
  mesh.positions.resize(count);
  if (!mesh.normals.empty()) mesh.normals.resize(count);
  if (!mesh.uvs.empty()) mesh.uvs.resize(count);
  for (auto& t : mesh.triangles)
    for (uint32_t& i : t) i = index[i];
}

}  // namespace

bool add_by_side(ImportedMesh mesh, const std::vector<std::array<float, 4>>& tangents, ImportedScene& scene,
                 std::vector<uint32_t>& to) {
  const auto add = [&](ImportedMesh added) {
    remove_unused(added);
    to.push_back(uint32_t(scene.meshes.size()));
    scene.meshes.push_back(std::move(added));
  };
  const ImportedMaterial& material = scene.materials[mesh.material];
  bool is_turned = false;
  std::vector<std::array<uint32_t, 3>> opposite;
  if (material.normal_texture.image >= 0 && material.normal_texture.shares_uv(material.uv_texture()) &&
      !mesh.uvs.empty())
    std::erase_if(mesh.triangles, [&](const auto& t) {
      const Direction d = direction_of(mesh, t);
      bool is_opposite = d.area < 0;
      if (!tangents.empty() && d.area != 0) {
        constexpr double kLeast = 0.5;  // cosine: vertices' tangents are means of several triangles'
        const auto& tangent = tangents[t[0]];
        const Vec3d direction = to_double(Vec3{tangent[0], tangent[1], tangent[2]});
        is_turned = is_turned || !(dot(direction, d.u) > kLeast * length(d.u) * length(direction));
        is_opposite = tangent[3] < 0;
      }
      if (is_opposite) opposite.push_back(t);
      return is_opposite;
    });
  if (opposite.empty()) {
    add(std::move(mesh));
    return is_turned;
  }
  ImportedMesh other = mesh;
  other.triangles = std::move(opposite);
  other.material = inverted(mesh.material, scene);
  if (!mesh.triangles.empty()) add(std::move(mesh));
  add(std::move(other));
  return is_turned;
}

}  // namespace frond
