// A scene with a period against instances of it written out side by side.

#include "scene/geometry/tiling.h"

#include <gtest/gtest.h>

#include "core/log.h"
#include "core/math/random.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

constexpr int kAround = 12;

std::unique_ptr<Scene> scene(const std::string& options, const std::string& world, ThreadPool& pool) {
  const Registry registry = make_registry(builtin_materials(), builtin_integrators());
  const std::string text = options + "WorldBegin LightSource \"infinite\"\n" + world;
  SceneDescription description = parse_scene_text(text, "test.pbrt", silent_log());
  set_wavelengths(description, "smpte");
  return std::make_unique<Scene>(description, registry, pool, silent_log());
}

/// Objects that extend beyond a period, in both directions.
const std::string kObject = R"(
ObjectBegin "plot" Shape "disk" "float radius" .7
Translate 1.2 .4 .5 Rotate 70 1 2 0 Shape "disk" "float radius" .9
Translate -2 .8 .6 Shape "sphere" "float radius" .4 ObjectEnd
)";

TEST(Tiling, IsMetWhereItsCopiesAre) {
  ThreadPool pool(2);
  const auto endless = scene("Option \"float period\" [2 1.5]\n", kObject + "ObjectInstance \"plot\"", pool);
  std::string instances = kObject;
  for (int i = -kAround; i <= kAround; ++i)
    for (int j = -kAround; j <= kAround; ++j)
      instances +=
          fmt::format("AttributeBegin Translate {} {} 0 ObjectInstance \"plot\" AttributeEnd\n", 2 * i, 1.5 * j);
  const auto written_out = scene("", instances, pool);
  RandomStream random(5);
  const auto uniform = [&random](float a, float b) { return a + (b - a) * random.uniform(); };
  int hits = 0, differ = 0;
  for (int i = 0; i < 20000; ++i) {
    // Not so flat that a ray comes to the end of the instances.
    const Ray ray{
        {uniform(-2, 2), uniform(-2, 2), uniform(-1, 3)},
        normalize(Vec3{uniform(-1, 1), uniform(-1, 1), (random.uniform() < 0.5f ? 1 : -1) * uniform(0.3f, 1)})};
    SurfacePoint a, b;
    const bool hit_a = endless->intersect(ray, 0, a), hit_b = written_out->intersect(ray, 0, b);
    EXPECT_EQ(hit_a, endless->occluded(ray, 0));
    if (hit_a != hit_b || (hit_a && length(a.hit.p - b.hit.p) > 1e-4f)) {
      ++differ;
      continue;
    }
    if (!hit_a) continue;
    ++hits;
    EXPECT_LT(length(a.hit.ng - b.hit.ng), 1e-3f);
    EXPECT_EQ(a.instance_id, 1u) << "an instance of the scene is no instance in it";
  }
  EXPECT_GT(hits, 5000) << "the test has lost its power";
  EXPECT_LE(differ, 4) << "rays along an edge";
}

/// Leaves at the border of a plot make it a little wider than its period.
TEST(Tiling, VisitsAnOverlappingRepetitionOnlyNearTheBorder) {
  const Tiling tiling({1, 1}, {{0, 0, 0}, {1.1f, 1.1f, 2}});
  const auto visited = [&](float x, float y) {
    std::vector<std::pair<float, float>> shifts;
    tiling.march({{x, y, 3}, {0, 0, -1}}, [&](const Tiling::Repeat& repeat) {
      shifts.emplace_back(repeat.shift.x, repeat.shift.y);
      return false;
    });
    return shifts;
  };
  using Shifts = std::vector<std::pair<float, float>>;
  EXPECT_EQ(visited(0.5f, 0.5f), (Shifts{{0, 0}}));
  EXPECT_EQ(visited(0.05f, 0.5f), (Shifts{{0, 0}, {-1, 0}}));
  EXPECT_EQ(visited(0.5f, 0.05f), (Shifts{{0, 0}, {0, -1}}));
  EXPECT_EQ(visited(3.05f, -1.95f), (Shifts{{3, -2}, {3, -3}, {2, -2}, {2, -3}}));
}

TEST(Tiling, AFlatRayBetweenThingsLeavesTheScene) {
  ThreadPool pool(1);
  const auto endless =
      scene("Option \"float period\" [2 2]\n",
            "Shape \"disk\" \"float radius\" .5 Translate 0 0 1 Shape \"disk\" \"float radius\" .5", pool);
  SurfacePoint point;
  EXPECT_FALSE(endless->intersect({{0, 0, 0.5f}, {1, 0, 0}}, 0, point));
  EXPECT_TRUE(endless->intersect({{0, 0, 0.5f}, normalize(Vec3{1, 0, -1e-3f})}, 0, point));
  EXPECT_NEAR(point.hit.p.z, 0, 1e-3f);
}

TEST(Tiling, OnePlaneGoesOnForEver) {
  ThreadPool pool(1);
  const auto endless = scene("Option \"float period\" [1 1]\n",
                             "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]", pool);
  RandomStream random(3);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 d = normalize(Vec3{random.uniform() - 0.5f, random.uniform() - 0.5f, -0.05f - random.uniform()});
    SurfacePoint point;
    ASSERT_TRUE(endless->intersect({{random.uniform() * 30, random.uniform() * 30, 2}, d}, 0, point)) << i;
  }
}

TEST(Tiling, BadPeriodsAreRefused) {
  ThreadPool pool(1);
  const auto error = [&](const std::string& options, const std::string& world) {
    return error_of([&] { scene(options, world, pool); });
  };
  EXPECT_NE(error("Option \"float period\" [1]\n", "").find("takes 2 values"), std::string::npos);
  EXPECT_NE(error("Option \"float period\" [0 1]\n", ""), "");
  // A ray would visit each of the cells.
  EXPECT_NE(error("Option \"float period\" [1 1]\n", "Shape \"sphere\" \"float radius\" 1e4").find("periods wide: 64"),
            std::string::npos);
  const std::string outside = "takes light from outside alone: \"distant\", \"sky\", or \"infinite\" without a portal";
  const std::string two = "Option \"float period\" [1 1]\n", even = "LightSource \"infinite\"\n";
  for (const char* light :
       {"LightSource \"point\"", "LightSource \"infinite\" \"point3 portal\" [0 0 0 0 1 0 1 1 0 1 0 0]",
        "AreaLightSource \"diffuse\" Shape \"disk\""}) {
    const std::string message = error(two, even + light);
    EXPECT_NE(message.find(outside), std::string::npos) << message;
    EXPECT_NE(message.find(":4:"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace frond
