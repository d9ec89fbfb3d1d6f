#include "imports/scene_stream.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "imports/plant_geometry.h"
#include "imports/plant_materials.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

/// Two nodes: the second is a child of the first and has a triangle.
ImportedScene a_scene() {
  ImportedScene scene;
  scene.images = {{"leaf.png", {1, 2, 3}, "png"}};
  scene.materials = {{.name = "leaf"}};
  scene.materials[0].color_texture = {.image = 0, .uv_set = 1};
  scene.meshes = {{.name = "m",
                   .material = 0,
                   .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                   .normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                   .uvs = {{0, 0}, {1, 0}, {0, 1}},
                   .triangles = {{0, 1, 2}}}};
  scene.nodes = {{.name = "root", .parent = -1, .to_parent = {2, 0, 0, 10, 0, 2, 0, 20, 0, 0, 2, 30}},
                 {.name = "child", .parent = 0, .to_parent = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3}, .meshes = {0}}};
  scene.lights = {{.type = ImportedLight::Type::spot, .color = {1, 2, 3}, .inner = 0.1, .outer = 0.2}};
  scene.cameras = {{.is_orthographic = true, .half = {2, 1}}};
  scene.losses = {{"animation", 2}, {"gloss", 1, {"leaf"}, true}};
  scene.warnings = {"a warning"};
  return scene;
}

TEST(SceneStream, ASceneIsReadAsItWasWritten) { EXPECT_EQ(decode(encode(a_scene())), a_scene()); }

TEST(SceneStream, EveryTruncationIsAnError) {
  const std::string bytes = encode(a_scene());
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(decode(std::string_view(bytes).substr(0, size)), std::runtime_error) << size;
  EXPECT_THROW(decode(bytes + "x"), std::runtime_error);
}

TEST(SceneStream, InvalidIndicesAndNumbersAreErrors) {
  const auto is_refused = [](auto change) {
    ImportedScene scene = a_scene();
    change(scene);
    EXPECT_THROW(decode(encode(scene)), std::runtime_error);
  };
  is_refused([](ImportedScene& s) { s.meshes[0].material = 1; });
  is_refused([](ImportedScene& s) { s.meshes[0].triangles[0][1] = 3; });
  is_refused([](ImportedScene& s) { s.meshes[0].normals.pop_back(); });
  is_refused([](ImportedScene& s) { s.meshes[0].uvs.pop_back(); });
  is_refused([](ImportedScene& s) { s.meshes[0].positions[0][0] = std::numeric_limits<float>::infinity(); });
  is_refused([](ImportedScene& s) { s.nodes[0].parent = 0; });
  is_refused([](ImportedScene& s) { s.nodes[1].meshes[0] = 1; });
  is_refused([](ImportedScene& s) { s.nodes[1].to_parent[0] = std::nan(""); });
  is_refused([](ImportedScene& s) { s.materials[0].color_texture.image = 1; });
  is_refused([](ImportedScene& s) { s.materials[0].emission[2] = std::numeric_limits<float>::infinity(); });
  is_refused([](ImportedScene& s) { s.lights[0].color[1] = -1; });
  is_refused([](ImportedScene& s) { s.lights[0].inner = 0.3; });
  is_refused([](ImportedScene& s) { s.lights[0].to_world[3] = std::nan(""); });
  is_refused([](ImportedScene& s) { s.cameras[0].half[0] = 0; });
  is_refused([](ImportedScene& s) { s.cameras[0].to_world[3] = std::nan(""); });
}

/// p = to_world * root * child * v, computed by hand: child turns (1, 0, 0) to (0, 1, 0) and shifts to (1, 3, 3); root
/// makes (12, 26, 36) of it; z-up: (12, -36, 26).
TEST(PlantGeometry, AVertexIsWhereItsNodesPutIt) {
  const NodeMap y_up{{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0}};
  const PlantGeometry geometry = plant_geometry(a_scene(), y_up);
  ASSERT_EQ(geometry.meshes.size(), 1u);
  EXPECT_EQ(geometry.meshes[0].p[1], (Vec3{12, -36, 26}));
  EXPECT_EQ(geometry.meshes[0].n[0], (Vec3{0, -1, 0}));
  EXPECT_EQ(geometry.least, (Vec3d{10, -36, 24}));
}

TEST(PlantGeometry, MirroringKeepsTheFront) {
  ImportedScene scene = a_scene();
  scene.nodes[0].to_parent = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const PlantMesh mesh = plant_geometry(scene, {}).meshes[0];
  const auto& [a, b, c] = mesh.triangles[0];
  const Vec3 normal = cross(mesh.p[b] - mesh.p[a], mesh.p[c] - mesh.p[a]);
  EXPECT_GT(normal.z, 0);
  EXPECT_EQ(mesh.n[0], (Vec3{0, 0, 1}));
}

TEST(PlantGeometry, MeshesOfSeveralNodesAreObjectsAndFlatNodesAreLeftOut) {
  ImportedScene scene = a_scene();
  scene.nodes.push_back(scene.nodes[1]);
  scene.nodes.push_back(scene.nodes[1]);
  scene.nodes.back().to_parent = {};
  const PlantGeometry geometry = plant_geometry(scene, {});
  EXPECT_TRUE(geometry.meshes.empty());
  ASSERT_EQ(geometry.objects.size(), 1u);
  EXPECT_EQ(geometry.objects[0].instances.size(), 2u);
  EXPECT_EQ(geometry.instance_count(), 2u);
  EXPECT_EQ(geometry.flat_nodes, 1u);
  EXPECT_EQ(geometry.objects[0].instances[0].point({1, 0, 0}), (Vec3d{12, 26, 36}));
}

/// Objects cannot emit: instances of meshes that do are meshes, unless they are many.
TEST(PlantGeometry, InstancesThatEmitAreMeshes) {
  ImportedScene scene = a_scene();
  scene.nodes.push_back(scene.nodes[1]);
  scene.materials[0].emission = {0, 1, 0};
  for (const bool keeps_objects : {false, true}) {
    const PlantGeometry geometry = plant_geometry(scene, {}, keeps_objects);
    EXPECT_TRUE(geometry.objects.empty());
    ASSERT_EQ(geometry.meshes.size(), 1u);
    EXPECT_EQ(geometry.meshes[0].triangles.size(), 2u);
  }
  scene.meshes[0].triangles.assign(500'001, {0, 1, 2});
  EXPECT_EQ(plant_geometry(scene, {}).objects.size(), 1u);
}

TEST(PlantGeometry, WithoutTrianglesOrBeyondAllBoundsIsAnError) {
  ImportedScene scene = a_scene();
  scene.nodes.pop_back();
  EXPECT_EQ(error_of([&] { plant_geometry(scene, {}); }), "the model has no node with triangles");
  scene = a_scene();
  scene.meshes[0].positions[0][0] = 1e18f;
  EXPECT_THAT(error_of([&] { plant_geometry(scene, {}); }), ::testing::HasSubstr("it needs a smaller scale"));
}

TEST(PlantMaterials, PatternsMatchNames) {
  EXPECT_TRUE(matches_pattern("leaf*", "Leaf.001"));
  EXPECT_TRUE(matches_pattern("*", "anything"));
  EXPECT_TRUE(matches_pattern("leaf?", "leaf1"));
  EXPECT_FALSE(matches_pattern("leaf", "leaf1"));
}

}  // namespace
}  // namespace frond
