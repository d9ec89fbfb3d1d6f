// Scenes far from the origin of their coordinates: which point becomes the origin of the rendered world, and that
// shapes, instances, lights, media, cameras and textures are the same as in a scene that lies there.

#include "scene/origin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/log.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/geometry/instance_table.h"
#include "scene/geometry/instance_writer.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "shapes/ply.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

constexpr Vec3d kMap{500000, 5200000, 312};

/// Keeps warnings.
class Recorder final : public Log {
 public:
  explicit Recorder(std::vector<std::string>& said) : said_(said) {}
  void info(std::string_view) const override {}
  void warn(const Location&, std::string_view message) const override { said_.emplace_back(message); }

 private:
  std::vector<std::string>& said_;
};

class Origin : public ::testing::Test {
 protected:
  SceneDescription parsed(const std::string& world, const std::string& options = "") {
    SceneDescription description = parse_scene_text(options + "WorldBegin\n" + world, folder_.name_of("s.pbrt"), log_);
    set_wavelengths(description, "smpte");
    return description;
  }
  std::unique_ptr<Scene> scene(const std::string& world, const std::string& options = "") {
    return std::make_unique<Scene>(parsed(world, options), registry_, pool_, log_);
  }
  SceneOrigins origins(const std::string& world) { return find_origins(parsed(world), log_); }
  /// Points at which a grid of vertical rays meets a scene; (0, 0, -1) where it misses.
  static std::vector<Vec3> heights(const Scene& scene) {
    std::vector<Vec3> points;
    for (int i = -20; i <= 20; ++i)
      for (int j = -20; j <= 20; ++j) {
        SurfacePoint at;
        const bool met = scene.intersect({{float(i) * 0.053f, float(j) * 0.053f, 9}, {0, 0, -1}, INFINITY}, 0, at);
        points.push_back(met ? at.hit.p : Vec3{0, 0, -1});
      }
    return points;
  }
  void expect_same(const Scene& here, const Scene& there, float slack) {
    const std::vector<Vec3> a = heights(here), b = heights(there);
    size_t others = 0;
    float most = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      const float distance = length(a[i] - b[i]);
      others += !(distance <= slack);
      if (distance < 0.1f) most = std::max(most, distance);
    }
    EXPECT_LE(others, a.size() / 200) << "a ray may pass an edge on its other side; points are up to " << most
                                      << " away";
  }
  /// Bytes of a PLY file with one square in doubles.
  std::string square(const std::string& name, const Vec3d& at, const char* type = "double") {
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty {0} x\nproperty {0} y\nproperty {0} z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n",
        type);
    for (const auto& [x, y] : {std::pair{-0.4, -0.3}, {0.5, -0.3}, {0.5, 0.35}, {-0.4, 0.35}})
      for (const double v : {x + at.x, y + at.y, 0.1 * x + at.z}) {
        const auto single = float(v);
        text.append(
            type == std::string("double") ? reinterpret_cast<const char*>(&v) : reinterpret_cast<const char*>(&single),
            type == std::string("double") ? 8 : 4);
      }
    text += '\4';
    for (const int i : {0, 1, 2, 3}) text.append(reinterpret_cast<const char*>(&i), 4);
    return folder_.write(name, text);
  }

  TestFolder folder_{"origin"};
  ThreadPool pool_{2};
  std::vector<std::string> said_;
  const Recorder log_{said_};
  Registry registry_ = make_registry(builtin_materials(), builtin_integrators());
};

constexpr const char* kLight = "LightSource \"infinite\"\n";

TEST_F(Origin, StaysWhereContentIsNear) {
  EXPECT_FALSE(origins("Shape \"sphere\" Translate 200 -250 0 Shape \"sphere\"").move_something);
  EXPECT_FALSE(origins("Shape \"disk\" \"float radius\" 1e6 Translate 1 2 3 Shape \"sphere\"").move_something);
  EXPECT_FALSE(origins("Translate 0 0 -1000 Shape \"sphere\" \"float radius\" 1000").move_something) << "reaches 0";
  EXPECT_FALSE(origins("Translate 0 0 -900 Shape \"disk\" \"float height\" 900").move_something);
  // Plants, and a mountain with many more vertices behind them.
  std::string mountain = "Translate 9000 0 0 Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [";
  for (int i = 0; i < 50; ++i) mountain += fmt::format("{} {} {} ", i % 7, i % 5, i % 3);
  EXPECT_EQ(origins("Shape \"sphere\" " + mountain + "]").world, Vec3d());
  EXPECT_TRUE(said_.empty());
}

TEST_F(Origin, GoesToTheMiddleOfWhatIsFar) {
  const std::string leaf = "AttributeBegin Translate {} {} 312.4 Shape \"disk\" \"float radius\" .05 AttributeEnd\n";
  std::string leaves;
  for (int i = 0; i < 5; ++i) leaves += fmt::format(fmt::runtime(leaf), 500000.3 + i, 5200000.4 - i);
  const SceneOrigins found = origins(leaves);
  EXPECT_EQ(found.world, (Vec3d{500002, 5199998, 312}));
  EXPECT_TRUE(found.move_something);
  EXPECT_EQ(origins("Shape \"disk\" \"float radius\" 1e7 " + leaves).world, found.world) << "a ground of any width";
  EXPECT_TRUE(said_.empty());
  EXPECT_EQ(origins("Shape \"sphere\" " + leaves).world, Vec3d()) << "something is near";
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_THAT(said_[0], HasSubstr("5 of 6 shapes and instances are small beside their distance from the others"));
  EXPECT_THAT(said_[0], HasSubstr("rounded to steps of 0.5"));
}

/// Shapes around (0, 0, 0) in coordinates that begin at `at`; by their points, or by a transform.
std::string points(const Vec3d& at, std::initializer_list<Vec3d> around) {
  std::string text = "\"point3 P\" [";
  for (const Vec3d& p : around) text += fmt::format("{:.9f} {:.9f} {:.9f} ", p.x + at.x, p.y + at.y, p.z + at.z);
  return text + "]";
}
std::string translate(const Vec3d& by) { return fmt::format("Translate {:.9f} {:.9f} {:.9f}\n", by.x, by.y, by.z); }

TEST_F(Origin, ShapesFarAwayAreTheSame) {
  const auto shapes = [](const Vec3d& at) {
    return std::vector<std::string>{
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] " +
            points(at, {{-0.7, -0.6, 0.1}, {0.5, -0.4, 0.2}, {-0.3, 0.6, 0}, {0.7, 0.9, 0.3}}),
        "Shape \"bilinearmesh\" " + points(at, {{-0.7, -0.6, 0.1}, {0.5, -0.4, 0.2}, {-0.3, 0.6, 0}, {0.7, 0.9, 0.9}}),
        "Shape \"loopsubdiv\" \"integer indices\" [0 1 2 1 3 2] " +
            points(at, {{-0.7, -0.6, 0.1}, {0.5, -0.4, 0.2}, {-0.3, 0.6, 0}, {0.7, 0.9, 0.3}}),
        "Shape \"curve\" \"float width\" 0.3 " +
            points(at, {{-0.9, -0.3, 0.1}, {-0.3, 0.9, 0.2}, {0.3, -0.9, 0}, {0.9, 0.3, 0.3}}),
        translate(at) + "Rotate 30 1 .2 .3 Shape \"sphere\" \"float radius\" .6",
        translate(at) + "Rotate 30 1 .2 .3 Shape \"cylinder\" \"float radius\" .6",
        translate(at) + "Translate .1 .2 .3 Scale 1 2 1 Shape \"disk\" \"float radius\" .4",
        "Scale 2 2 2 " + translate(at / 2.0) + "Shape \"disk\" \"float radius\" .4",
        translate(at) + "ConcatTransform [.6 .8 0 0 -.8 .6 0 0 0 0 1 0 .1 .2 .3 1] Shape \"trianglemesh\" " +
            points({}, {{-0.7, -0.6, 0.1}, {0.5, -0.4, 0.2}, {-0.3, 0.6, 0}})};
  };
  const auto here = shapes({}), there = shapes(kMap);
  for (size_t i = 0; i < here.size(); ++i) {
    SCOPED_TRACE(there[i]);
    const auto near = scene(kLight + here[i]), far = scene(kLight + there[i]);
    const Vec3d& origin = far->origin();
    EXPECT_LE(length(origin - kMap), 2);
    // The scene's origin is a whole number near its middle: the ray grid is moved there.
    const auto moved = scene(kLight + translate(kMap - origin) + here[i]);
    expect_same(*moved, *far, 1e-6f);
  }
  EXPECT_TRUE(said_.empty()) << said_[0];
}

TEST_F(Origin, MeshesOfDoublesKeepTheirShape) {
  square("here.ply", {});
  square("there.ply", kMap);
  square("floats.ply", kMap, "float");
  const auto near = scene(kLight + std::string("Shape \"plymesh\" \"string filename\" \"here.ply\""));
  const auto far = scene(kLight + std::string("Shape \"plymesh\" \"string filename\" \"there.ply\""));
  EXPECT_EQ(far->origin(), kMap);
  expect_same(*near, *far, 1e-7f);
  const auto back = scene(kLight + translate(-kMap) + "Shape \"plymesh\" \"string filename\" \"there.ply\"");
  EXPECT_EQ(back->origin(), Vec3d());
  expect_same(*near, *back, 1e-7f);
  const auto by_hand =
      scene(kLight +
            std::string("Shape \"plymesh\" \"string filename\" \"there.ply\" \"point3 origin\" [500000 5200000 312]"));
  EXPECT_EQ(by_hand->origin(), Vec3d());
  expect_same(*near, *by_hand, 1e-7f);
  EXPECT_TRUE(said_.empty());
  scene(kLight + std::string("Shape \"plymesh\" \"string filename\" \"floats.ply\""));
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_THAT(said_[0], HasSubstr("32-bit floats up to 4.19e+06 units from the origin, where their step is 0.5 units"));
}

TEST_F(Origin, ObjectsAndInstancesFarAwayAreTheSame) {
  const std::string disk = "Shape \"disk\" \"float radius\" .3 ";
  const auto near = scene(kLight + ("ObjectBegin \"o\" " + disk + "ObjectEnd Rotate 20 1 0 0 ObjectInstance \"o\""));
  const auto in_map = scene(
      kLight + ("ObjectBegin \"o\" " + disk + "ObjectEnd " + translate(kMap) + "Rotate 20 1 0 0 ObjectInstance \"o\""));
  expect_same(*near, *in_map, 1e-6f);
  const auto object_in_map =
      scene(kLight + ("ObjectBegin \"o\" AttributeBegin " + translate(kMap) + disk +
                      "AttributeEnd ObjectEnd Rotate 20 1 0 0 " + translate(-kMap) + "ObjectInstance \"o\""));
  EXPECT_EQ(object_in_map->origin(), Vec3d());
  expect_same(*near, *object_in_map, 1e-6f);
  const auto moving = scene(
      kLight + ("ObjectBegin \"o\" " + disk + "ObjectEnd " + translate(kMap) +
                "Rotate 20 1 0 0 ActiveTransform EndTime Translate 0 0 1 ActiveTransform All ObjectInstance \"o\""));
  expect_same(*near, *moving, 1e-6f);
  EXPECT_TRUE(said_.empty());
}

TEST_F(Origin, TablesOfDoublesKeepTheirPositions) {
  const auto write = [&](const char* name, const Vec3d& at, MapType type) {
    InstanceWriter writer(folder_.name_of(name), 3, {"share"}, type);
    for (int i = 0; i < 3; ++i) {
      const float value = float(i);
      writer.add(oriented_rows(Vec3d{0.3 * i - 0.3, 0.1, 0.2} + at, normalize(Vec3d{0.1, 0.2, 1}), 0, 0.2),
                 {&value, 1});
    }
    writer.finish();
  };
  write("here.npy", {}, MapType::single);
  write("there.npy", kMap, MapType::precise);
  write("floats.npy", kMap, MapType::single);
  const auto with = [](const std::string& table, const std::string& transform = "") {
    return "ObjectBegin \"o\" Shape \"disk\" ObjectEnd " + transform +
           "Shape \"instances\" \"string object\" \"o\" \"string filename\" \"" + table + "\"";
  };
  const auto near = scene(kLight + with("here.npy")), far = scene(kLight + with("there.npy"));
  EXPECT_EQ(far->origin(), kMap);
  expect_same(*near, *far, 1e-6f);
  expect_same(*near, *scene(kLight + with("here.npy", translate(kMap))), 1e-6f);
  expect_same(*near, *scene(kLight + with("there.npy", translate(-kMap))), 1e-6f);
  EXPECT_TRUE(said_.empty());
  const InstanceTable table(folder_.name_of("there.npy"), {}, pool_, {.table = kMap});
  ASSERT_EQ(table.columns().size(), 1u);
  EXPECT_EQ(table.columns()[0].range.max, 2);
  EXPECT_EQ(table.origin(), kMap);
  scene(kLight + with("floats.npy"));
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_THAT(said_[0], HasSubstr("where their step is 0.5 units"));
}

TEST_F(Origin, LightsAndCamerasFollow) {
  const std::string leaf = "Shape \"disk\" \"float radius\" .3 ";
  const auto view = [](const Vec3d& at) {
    return fmt::format("LookAt {} {} {}  {} {} {}  0 0 1 Camera \"perspective\" \"float fov\" 40\n", at.x, at.y - 2,
                       at.z + 1.5, at.x, at.y, at.z + 0.25);
  };
  const auto world = [&](const Vec3d& at) {
    return translate(at) + leaf + "Identity\n" +
           fmt::format(
               "LightSource \"point\" \"point3 from\" [{0} {1} {2}]\nLightSource \"spot\" \"point3 from\" [{0} {1} "
               "{2}] \"point3 to\" [{3} {4} {5}]\n",
               at.x + 0.5, at.y + 0.25, at.z + 2, at.x, at.y, at.z) +
           fmt::format("LightSource \"infinite\" \"point3 portal\" [{0} {2} {4} {0} {3} {4} {1} {3} {4} {1} {2} {4}]\n",
                       at.x - 1, at.x + 1, at.y - 1, at.y + 1, at.z + 3);
  };
  const auto near = scene(world({}), view({})), far = scene(world(kMap), view(kMap));
  EXPECT_EQ(far->origin(), kMap);
  for (const float x : {0.f, 17.f, 300.f}) {
    const Ray a = near->camera().ray({x, 40}, {0.5f, 0.5f}), b = far->camera().ray({x, 40}, {0.5f, 0.5f});
    EXPECT_LE(length(a.o - b.o), 1e-6f);
    EXPECT_LE(length(a.d - b.d), 1e-6f);
  }
  const SampledWavelengths lambda = near->wavelengths().sample(0.5f);
  for (size_t i = 0; i < 3; ++i) {
    const auto a = near->lights()[i]->sample({0.1f, 0.2f, 0}, {0.3f, 0.6f}, lambda);
    const auto b = far->lights()[i]->sample({0.1f, 0.2f, 0}, {0.3f, 0.6f}, lambda);
    ASSERT_TRUE(a && b) << i;
    EXPECT_LE(length(a->wi - b->wi), 1e-6f) << i;
    EXPECT_NEAR(a->radiance[0], b->radiance[0], 1e-5f * a->radiance[0]) << i;
  }
}

TEST_F(Origin, TexturesAndMediaFollow) {
  const auto world = [&](const Vec3d& at) {
    return fmt::format(
               "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"point3 p0\" [{} {} {}] \"point3 p1\" [{} {} "
               "{}] "
               "\"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 1 \"float density\" [1 3]\n",
               at.x - 1, at.y - 1, at.z - 1, at.x + 1, at.y + 1, at.z + 1) +
           fmt::format(
               "Texture \"t\" \"float\" \"checkerboard\" \"string mapping\" \"planar\" \"vector3 v1\" [2 0 0] "
               "\"vector3 v2\" [0 2 0] \"float udelta\" {} \"float vdelta\" {} \"float tex1\" 0 \"float tex2\" 1\n",
               0.25 - 2 * at.x, 0.25 - 2 * at.y) +
           translate(at) + "MediumInterface \"m\" \"\" Shape \"trianglemesh\" \"texture alpha\" \"t\" " +
           points({}, {{-0.9, -0.8, 0}, {0.95, -0.6, 0.1}, {0, 0.9, 0.2}});
  };
  const auto near = scene(kLight + world({})), far = scene(kLight + world(kMap));
  EXPECT_EQ(far->origin(), kMap);
  expect_same(*near, *far, 1e-6f);
  const SampledWavelengths lambda = near->wavelengths().sample(0.5f);
  for (const float x : {-0.7f, 0.1f, 0.6f}) {
    const auto *a = near->medium_interfaces()[0].inside, *b = far->medium_interfaces()[0].inside;
    EXPECT_NEAR(a->properties({x, 0, 0}, lambda).sigma_s[0], b->properties({x, 0, 0}, lambda).sigma_s[0], 1e-5f);
  }
}

}  // namespace
}  // namespace frond
