// Output of the process that reads a model, and the geometry made from it.

#include <cmath>
#include <stdexcept>

#include "imports/double_sheets.h"
#include "imports/scene_stream.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(model_stream, bytes) {
  ImportedScene scene;
  try {
    scene = decode(bytes);
  } catch (const std::runtime_error&) {
    return;
  }
  fuzz::require(encode(scene) == bytes, "a scene is written as it was read");
  PlantGeometry geometry;
  if (!fuzz::accepts([&] { geometry = plant_geometry(scene, {}); })) return;
  for (const PlantMesh& mesh : geometry.meshes) {
    for (const Vec3& p : mesh.p) fuzz::require(std::isfinite(p.x + p.y + p.z), "positions are finite");
    fuzz::require(mesh.n.empty() || mesh.n.size() == mesh.p.size(), "each vertex has a normal, or none has");
    fuzz::require(mesh.uv.empty() || mesh.uv.size() == mesh.p.size(), "each vertex has coordinates, or none has");
    for (const auto& t : mesh.triangles)
      for (const uint32_t i : t) fuzz::require(i < mesh.p.size(), "vertices exist");
  }
  double_sheets(geometry.meshes, 1e-3 * length(geometry.most - geometry.least),
                std::vector<bool>(scene.materials.size(), true));
}
