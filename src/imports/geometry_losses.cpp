#include "imports/geometry_losses.h"

#include <algorithm>

#include "core/parallel.h"
#include "imports/plant_geometry.h"

namespace frond {
namespace {

/// Whether the texture coordinates have the opposite orientation of the vertices. The normal map's y axis follows v in
/// the model; in frond it completes a right-handed frame.
bool is_mirrored(const ImportedMesh& mesh, const std::array<uint32_t, 3>& t) {
  const auto along = [&](size_t corner, size_t axis) {
    return double(mesh.uvs[t[corner]][axis]) - double(mesh.uvs[t[0]][axis]);
  };
  return along(1, 0) * along(2, 1) < along(2, 0) * along(1, 1);
}

}  // namespace

void add_geometry_losses(ImportedScene& scene) {
  LossList losses;
  for (const ImportedMesh& mesh : scene.meshes) {
    check_stop();
    const ImportedMaterial& material = scene.materials[mesh.material];
    if (!mesh.normals.empty() && !has_normals(mesh)) losses.add("normals of a mesh, of which some are 0 or not given");
    const bool has_map = material.normal_texture.image >= 0 && material.normal_texture.shares_uv(material.uv_texture());
    if (has_map && !mesh.uvs.empty() &&
        std::ranges::any_of(mesh.triangles, [&mesh](const auto& t) { return is_mirrored(mesh, t); }))
      losses.add_for_material(
          material.name, "direction of the normal map where texture coordinates are mirrored (it is inverted)", true);
  }
  scene.losses.insert(scene.losses.end(), losses.all().begin(), losses.all().end());
}

}  // namespace frond
