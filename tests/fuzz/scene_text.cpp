// Scene files up to the description: tokens, directives, includes, pbrt's plug-ins.

#include "core/math/motion.h"
#include "core/messages/problems.h"
#include "render/plugins.h"
#include "scene/read_scene.h"
#include "tests/fuzz/scene_input.h"

using namespace frond;

static void check(const SceneDescription& scene, size_t bytes) {
  const auto check_shapes = [&](const std::vector<ShapeDescription>& shapes) {
    for (const ShapeDescription& shape : shapes) {
      fuzz::require(shape.material < scene.materials.size(), "a shape's material exists");
      fuzz::require(!shape.area_light || *shape.area_light < scene.area_lights.size(), "a shape's light exists");
      for (const auto& row : shape.world_from_object.rows()) fuzz::require_finite(row, "a transform");
    }
  };
  const auto check_instances = [&](const InstanceList& instances) {
    fuzz::require(instances.maps->size() == instances.objects.size(), "each instance has an object");
    for (const uint32_t i : instances.objects) fuzz::require(i < scene.objects.size(), "an instance's object exists");
    for (const AffineMap& map : *instances.maps)
      for (const auto& row : map.rows) fuzz::require_finite(row, "an instance's map");
    for (const MovingInstance& moving : instances.moving) {
      fuzz::require(moving.object < scene.objects.size(), "a moving instance's object exists");
      const Motion motion(moving.start, moving.end, {0, 1});
      for (const float time : {0.f, 0.5f, 1.f})
        for (const auto& row : motion.at(time).rows) fuzz::require_finite(row, "a moving instance's map");
    }
  };
  check_shapes(scene.shapes), check_instances(scene.instances);
  for (const ObjectDescription& object : scene.objects) check_shapes(object.shapes), check_instances(object.instances);
  // An included file may be included repeatedly: the sum is bounded by the reader's budget only.
  if (scene.files.size() <= 1)
    fuzz::require(scene.shapes.size() + scene.materials.size() + scene.textures.size() <= bytes + 1,
                  "a directive takes a byte or more");
}

FROND_FUZZ_TARGET(scene_text, bytes) {
  static const Registry registry = builtin_registry();
  const fuzz::SceneInput input(bytes);
  for (const char* unsupported : {"", "all"})
    fuzz::accepts([&] {
      const Unsupported policy = *unsupported ? Unsupported(unsupported) : Unsupported();
      check(read_scene_text(input.text(), input.name(), registry, silent_log(), policy), bytes.size());
    });
}
