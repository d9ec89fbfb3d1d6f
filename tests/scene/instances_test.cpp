// Instances of objects: tables as files, and intersections, compared with the same surfaces without instances.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/log.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/geometry/instance_table.h"
#include "scene/geometry/instance_writer.h"
#include "scene/geometry/npy.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class Instances : public ::testing::Test {
 protected:
  fs::path file(const std::string& name) const { return folder_.name_of(name); }
  fs::path write(const std::string& name, const std::string& bytes) const { return folder_.write(name, bytes); }
  /// A file as numpy.save writes it, with this header.
  fs::path write_npy(const std::string& name, const std::string& dict, const std::vector<float>& numbers) const {
    std::string header = dict + std::string(64 - (10 + dict.size() + 1) % 64, ' ') + '\n';
    std::string bytes = "\x93NUMPY";
    bytes += {'\x01', '\x00', char(header.size() & 0xff), char(header.size() >> 8)};
    return write(name, bytes + header + std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * 4));
  }
  std::unique_ptr<Scene> scene(const std::string& world) {
    const fs::path path = write("scene.pbrt", "WorldBegin\nLightSource \"infinite\"\n" + world);
    SceneDescription description = parse_scene(path, silent_log());
    set_wavelengths(description, "smpte");
    return std::make_unique<Scene>(description, registry_, pool_, silent_log());
  }

  TestFolder folder_{"instances"};
  ThreadPool pool_{2};
  Registry registry_ = make_registry(builtin_materials(), builtin_integrators());
};

TEST_F(Instances, WhatIsWrittenIsRead) {
  AffineMap map{{{{1, 2, 3, 4}, {0, 1, 6, 7}, {0, 0, 2, 9}}}};
  InstanceWriter writer(file("t.npy"), 3, {"chlorophyll", "age"});
  for (int i = 0; i < 3; ++i) {
    map.rows[0][3] = float(i);
    writer.add(map, std::vector<float>{float(10 - i), float(i) / 2});
  }
  writer.finish();
  const InstanceTable table(file("t.npy"), {}, pool_);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table.map(2).rows, map.rows);
  ASSERT_EQ(table.columns().size(), 2u);
  EXPECT_EQ(table.columns()[0].name, "chlorophyll");
  EXPECT_EQ(table.columns()[0].range.min, 8);
  EXPECT_EQ(table.columns()[1].range.max, 1);
  InstanceRows rows;
  rows.add(table.columns(), table.bytes(1));
  EXPECT_EQ(rows.find("chlorophyll"), 9.f);
  EXPECT_EQ(rows.find("age"), 0.5f);
  EXPECT_FALSE(rows.find("height"));
}

TEST_F(Instances, AFileThatIsNotFinishedIsNotThere) {
  { const InstanceWriter writer(file("t.npy"), 3, {}); }
  EXPECT_TRUE(fs::is_empty(folder_.name_of("")));
}

TEST_F(Instances, ReadsWhatNumpyWrites) {
  const std::vector<float> one{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7};
  for (const char* dict : {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 12), }",
                           "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3, 4), }",
                           "{'descr': [('transform', '<f4', (12,))], 'fortran_order': False, 'shape': (1,), }",
                           "{'descr': [('transform', '<f4', (3, 4))], 'fortran_order': False, 'shape': (1,), }"}) {
    const InstanceTable table(write_npy("t.npy", dict, one), {}, pool_);
    ASSERT_EQ(table.size(), 1u) << dict;
    EXPECT_EQ(table.map(0).point({1, 1, 1}), (Vec3{6, 7, 8}));
  }
  std::vector<float> padded = one;
  padded.insert(padded.begin(), {42, 0});
  const InstanceTable table(
      write_npy("p.npy",
                "{'descr': [('age', '<f4'), ('', '|V4'), ('transform', '<f4', (3, 4))], 'fortran_order': False, "
                "'shape': (1,), }",
                padded),
      {}, pool_);
  EXPECT_EQ(table.map(0).point({0, 0, 0}), (Vec3{5, 6, 7}));
  EXPECT_EQ(table.columns().at(0).range.min, 42);
}

TEST_F(Instances, BadFilesAreRefusedByName) {
  const std::vector<float> row{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const auto error = [&](const fs::path& path) {
    return error_of([&] { const InstanceTable table(path, {}, pool_); });
  };
  EXPECT_THAT(error(file("none.npy")), HasSubstr("none.npy"));
  EXPECT_THAT(error(write("a.npy", "hello there, this is text")), HasSubstr("a.npy: it is no NumPy file"));
  EXPECT_THAT(error(write("e.npy", "")), HasSubstr("it is no NumPy file"));
  EXPECT_THAT(error(write_npy("b.npy", "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 12), }", row)),
              HasSubstr("cut short: it says 2 rows and has 1"));
  EXPECT_THAT(error(write_npy("c.npy", "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 6), }", row)),
              HasSubstr("\"the array\" holds <f8: numbers are <f4"));
  EXPECT_THAT(error(write_npy("d.npy", "{'descr': '<f4', 'fortran_order': True, 'shape': (1, 12), }", row)),
              HasSubstr("its columns stand one after another"));
  EXPECT_THAT(
      error(write_npy("f.npy", "{'descr': [('x', '<f4', (12,))], 'fortran_order': False, 'shape': (1,), }", row)),
      HasSubstr("\"x\" has 12 numbers in a row"));
  EXPECT_THAT(error(write_npy("g.npy", "{'descr': '<f4', 'shape': }", row)), HasSubstr("its header"));
  std::vector<float> flat = row;
  flat.insert(flat.end(), {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0});
  EXPECT_THAT(error(write_npy("h.npy", "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 12), }", flat)),
              HasSubstr("row 1 (counted from 0): its map cannot be inverted"));
  flat[20] = NAN;
  EXPECT_THAT(error(write_npy("i.npy", "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 12), }", flat)),
              HasSubstr("row 1"));
}

/// Headers with sizes that overflow or are invalid.
TEST_F(Instances, SizesThatNoFileHasAreRefused) {
  const auto error = [this](const std::string& descr, const std::string& shape) {
    const std::string dict = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", descr, shape);
    const fs::path path = write_npy("t.npy", dict, std::vector<float>(24, 1));
    return error_of([&] { InstanceTable(path, {}, pool_); });
  };
  const std::string map = "('transform', '<f4', (12,))";
  EXPECT_THAT(error("[('', '|V8', (1152921504606846976,)), " + map + ", ('', '|V8', (1152921504606846976,))]", "(1,)"),
              HasSubstr("t.npy: its rows have more than"));
  EXPECT_THAT(error("[('', '|V4000000000000000000'), " + map + "]", "(1,)"), HasSubstr("its rows have more than"));
  EXPECT_THAT(error("[('x', '<f4', (4294967296, 4294967296, 2)), " + map + "]", "(1,)"), HasSubstr("its rows"));
  for (const char* shape : {"(1e300, 12)", "(-1, 12)", "(1.5, 12)", "('a', 12)", "(18446744073709551616, 12)"})
    EXPECT_THAT(error("'<f4'", shape), HasSubstr("t.npy: ")) << shape;
  EXPECT_THAT(error("'<f4'", "(18446744073709551615, 12)"), HasSubstr("cut short"));
}

/// A table is a copy: a file that changes later is another one.
TEST_F(Instances, AFileThatChangesChangesNoTable) {
  const fs::path path = write_npy("t.npy", "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 12), }",
                                  {1, 0, 0, 7, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 8, 0, 1, 0, 0, 0, 0, 1, 0});
  const InstanceTable table(path, {}, pool_);
  fs::resize_file(path, 0);
  EXPECT_EQ(table.map(0).rows[0][3], 7);
  EXPECT_EQ(table.map(1).rows[0][3], 8);
}

TEST_F(Instances, BadScenesAreRefusedWithTheirPlace) {
  write_npy("t.npy", "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 12), }",
            {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  const std::string leaf = "ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd\n";
  EXPECT_THAT(error_of([&] { scene(leaf + R"(Shape "instances" "string object" "laef" "string filename" "t.npy")"); }),
              HasSubstr("scene.pbrt:4:35: there is no object \"laef\"; did you mean \"leaf\"?"));
  EXPECT_THAT(error_of([&] {
                scene(R"(ObjectBegin "a" Shape "instances" "string object" "a" "string filename" "t.npy" ObjectEnd)");
              }),
              HasSubstr("object \"a\" holds an instance of itself"));
  EXPECT_THAT(error_of([&] { scene(leaf + R"(Shape "instances" "string object" "leaf" "string filename" "u.npy")"); }),
              HasSubstr("u.npy"));
  std::string deep = leaf;
  for (int i = 0; i < 5; ++i)
    deep += fmt::format("ObjectBegin \"o{}\" ObjectInstance \"{}\" ObjectEnd\n", i,
                        i == 0 ? "leaf" : fmt::format("o{}", i - 1));
  EXPECT_THAT(error_of([&] { scene(deep + "ObjectInstance \"o4\""); }),
              HasSubstr("scene.pbrt:7:13: instances of objects are nested more than 4 deep in object \"o3\""));
}

/// A leaf that is no flat thing, and its instances written out in the world's own space.
std::string leaf_shapes(const std::string& transform = "") {
  return "AttributeBegin " + transform +
         R"( Shape "trianglemesh" "point3 P" [0 0 0  1 0 .2  1 1 0  0 1 .3] "integer indices" [0 1 2  0 2 3]
Translate .5 .5 .4 Shape "sphere" "float radius" .3 Translate 0 0 .5 Shape "disk" "float radius" .4 AttributeEnd
)";
}

/// Rays through a box, in all directions.
template <class Look>
void for_each_ray(const Look& look) {
  RandomStream random(7);
  for (int i = 0; i < 20000; ++i) {
    const auto uniform = [&random](float a, float b) { return a + (b - a) * random.uniform(); };
    const Vec3 from{uniform(-6, 6), uniform(-6, 6), uniform(-6, 6)}, to{uniform(-4, 4), uniform(-4, 4), uniform(-4, 4)};
    look(Ray{from, normalize(to - from)}, uint64_t(i));
  }
}

/// Hits and shadows of instances must equal those of the same surfaces without instances.
void expect_same(const Scene& instances, const Scene& written_out) {
  int hits = 0, differ = 0;
  for_each_ray([&](const Ray& ray, uint64_t key) {
    SurfacePoint a, b;
    const bool hit_a = instances.intersect(ray, key, a), hit_b = written_out.intersect(ray, key, b);
    EXPECT_EQ(hit_a, instances.occluded(ray, key));
    // A ray along an edge may be on either side of it, after one rounding or another.
    if (hit_a != hit_b) {
      ++differ;
      return;
    }
    if (!hit_a) return;
    ++hits;
    if (length(a.hit.p - b.hit.p) > 1e-4f) {
      ++differ;
      return;
    }
    EXPECT_LT(length(a.hit.ng - b.hit.ng), 1e-3f);
    EXPECT_LT(length(a.hit.shading.z - b.hit.shading.z), 1e-3f);
    EXPECT_NEAR(a.hit.at.uv.x, b.hit.at.uv.x, 1e-3f);
  });
  EXPECT_GT(hits, 1000) << "the test has lost its power";
  EXPECT_LE(differ, 4);
}

/// Rays in packets have the same hits as single rays, and missing lanes are unchanged.
void expect_same_in_packets(const Scene& scene) {
  RandomStream random(5);
  const auto uniform = [&](float least, float most) { return least + (most - least) * random.uniform(); };
  int hits = 0, differ = 0;
  for (int n = 0; n < 9000; ++n) {
    const Vec3 from{uniform(-4, 4), uniform(-4, 4), uniform(3, 5)}, to{uniform(-3, 3), uniform(-3, 3), uniform(-1, 1)};
    const float spread = n % 3 == 0 ? 3 : 0.02f;
    std::array<Ray, RayPacket::kWidth> rays;
    std::array<uint64_t, RayPacket::kWidth> keys;
    for (size_t i = 0; i < rays.size(); ++i) {
      const Vec3 aside{uniform(-spread, spread), uniform(-spread, spread), uniform(-spread, spread)};
      rays[i] = {from, to + aside - from, n % 2 == 0 ? INFINITY : uniform(0.5f, 1.5f)};
      keys[i] = random.bits();
    }
    const RayPacket packet{rays.data(), keys.data(), uint32_t(random.bits() & 0xff)};
    std::array<SurfacePoint, RayPacket::kWidth> points;
    for (SurfacePoint& p : points) p.material_id = 999;
    const uint32_t met = scene.intersect(packet, points.data()), dark = scene.occluded(packet);
    EXPECT_EQ((met | dark) & ~packet.lanes, 0u);
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!(packet.lanes >> i & 1)) {
        EXPECT_EQ(points[i].material_id, 999u);
        continue;
      }
      SurfacePoint alone;
      const bool is_hit = scene.intersect(rays[i], keys[i], alone);
      // Along an edge a ray may be on either side, after one rounding or another.
      if (is_hit != bool(met >> i & 1) || is_hit != bool(dark >> i & 1) ||
          (is_hit && length(alone.hit.p - points[i].hit.p) > 1e-4f)) {
        ++differ;
        continue;
      }
      if (!is_hit) continue;
      ++hits;
      EXPECT_LT(length(alone.hit.ng - points[i].hit.ng), 1e-3f);
      EXPECT_EQ(alone.instance_id, points[i].instance_id);
      EXPECT_EQ(alone.material, points[i].material);
    }
  }
  EXPECT_GT(hits, 1000) << "the test has lost its power";
  EXPECT_LE(differ, 4);
}

TEST_F(Instances, CopiesAreMetWhereTheirSurfacesAre) {
  const std::vector<std::string> placed{"Translate 2 0 0 Rotate 40 1 2 3", "Translate -2 1 0 Scale 2 .5 1",
                                        "Rotate 200 3 1 0 Translate 0 -2 1"};
  std::string instances = "ObjectBegin \"leaf\" " + leaf_shapes() + "ObjectEnd\n", flat;
  for (const std::string& t : placed) {
    instances += "AttributeBegin " + t + " ObjectInstance \"leaf\" AttributeEnd\n";
    flat += leaf_shapes(t);
  }
  expect_same(*scene(instances), *scene(flat));
  expect_same_in_packets(*scene(instances));
  expect_same_in_packets(*scene(flat));
}

/// Positions of hits are computed by the map whose inverse is stored.
TEST_F(Instances, HitsLieOnTheirRays) {
  struct Copy {
    const char* transform;
    float size;
  };
  for (const auto& [transform, size] :
       {Copy{"Scale -1 1 1 Rotate 40 1 2 3", 1}, Copy{"Rotate 40 1 2 3 Scale 1 1 1e-3", 1},
        Copy{"ConcatTransform [1 0 0 0  5 1 0 0  0 2 1 0  0 0 0 1]", 6}, Copy{"Scale 1e-6 1e-6 1e-6", 1e-6f},
        Copy{"Scale 1e6 1e6 1e6", 1e6f}}) {
    const auto copy =
        scene("ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd\n" + std::string(transform) + " ObjectInstance \"leaf\"");
    int hits = 0;
    for_each_ray([&](const Ray& ray, uint64_t key) {
      const Ray scaled{ray.o * size, ray.d, INFINITY};
      SurfacePoint point;
      if (!copy->intersect(scaled, key, point)) return;
      ++hits;
      const Vec3 way = point.hit.p - scaled.o;
      EXPECT_LT(length(cross(way, scaled.d)), 1e-5f * size) << transform;
      EXPECT_NEAR(length(point.hit.ng), 1, 1e-6);
    });
    EXPECT_GT(hits, 10) << transform;
  }
}

TEST_F(Instances, PacketsPassWhatIsPartlyTransparentAsRaysDo) {
  expect_same_in_packets(*scene(R"(
ObjectBegin "leaf"
  Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 .2  1 1 0  -1 1 .3] "integer indices" [0 1 2  0 2 3] "float alpha" .5
  Translate 0 0 .5 Shape "sphere" "float radius" .7 "float alpha" .4
ObjectEnd
ObjectBegin "disk" Shape "disk" "float alpha" .6 ObjectEnd
ObjectInstance "leaf"
AttributeBegin Translate 2 0 0 Rotate 40 1 2 3 ObjectInstance "leaf" AttributeEnd
AttributeBegin Translate -2 1 0 ObjectInstance "disk" AttributeEnd
Translate 0 0 -1 Scale 4 4 1 Shape "disk" "float alpha" .7)"));
}

TEST_F(Instances, TablesOfTablesAreMetWhereTheirSurfacesAre) {
  const std::vector<float> shoot{1, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1, .5f};
  const std::vector<float> plant{.7f, 0, 0, 0, 0, .7f, 0, 2, 0, 0, .7f, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1, 0};
  const char* dict = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 12), }";
  write_npy("shoot.npy", dict, shoot);
  write_npy("plant.npy", dict, plant);
  const std::string leaf = "ObjectBegin \"leaf\" " + leaf_shapes() + "ObjectEnd\n";
  const auto instances = scene(leaf + R"(
ObjectBegin "shoot" Shape "instances" "string object" "leaf" "string filename" "shoot.npy" ObjectEnd
Rotate 30 0 0 1 Shape "instances" "string object" "shoot" "string filename" "plant.npy")");
  // Column after column, as the format has matrices.
  const std::vector<std::string> shoots{"ConcatTransform [1 0 0 0  0 0 1 0  0 -1 0 0  1 0 0 1]",
                                        "ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  -1 0 .5 1]"};
  const std::vector<std::string> plants{"ConcatTransform [.7 0 0 0  0 .7 0 0  0 0 .7 0  0 2 0 1]",
                                        "ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 -2 0 1]"};
  std::string flat;
  for (const std::string& p : plants)
    for (const std::string& s : shoots) flat += leaf_shapes("Rotate 30 0 0 1 " + p + " " + s);
  expect_same(*instances, *scene(flat));
  expect_same_in_packets(*instances);
  EXPECT_EQ(instances->geometry().instances(), 4u);
}

// Small meshes beside instances become separate Embree scenes; large meshes do not.
TEST_F(Instances, SmallMeshesBesideThemAreMetAsLargeOnesAre) {
  const std::string world = "ObjectBegin \"leaf\" " + leaf_shapes() + R"(ObjectEnd
Shape "trianglemesh" "point3 P" [-4 -4 -1  4 -4 -1  4 4 -1  -4 4 -1] "integer indices" [0 1 2  0 2 3]
Shape "trianglemesh" "point3 P" [-4 2 -1  4 2 -1  4 3 2] "integer indices" [0 1 2] "float alpha" .5
ObjectInstance "leaf"
AttributeBegin Translate 2 0 0 Rotate 40 1 2 3 ObjectInstance "leaf" AttributeEnd
)";
  std::string far_away = "Shape \"trianglemesh\" \"point3 P\" [900 0 0  901 0 0  900 1 0] \"integer indices\" [";
  for (int i = 0; i < 100; ++i) far_away += " 0 1 2";
  const auto small = scene(world), large = scene(world + far_away + "]");
  int hits = 0;
  for_each_ray([&](const Ray& ray, uint64_t key) {
    SurfacePoint a, b;
    const bool is_hit = small->intersect(ray, key, a);
    EXPECT_EQ(is_hit, large->intersect(ray, key, b));
    EXPECT_EQ(is_hit, small->occluded(ray, key));
    EXPECT_EQ(is_hit, large->occluded(ray, key));
    if (!is_hit) return;
    ++hits;
    EXPECT_EQ(a.hit.p, b.hit.p);
    EXPECT_EQ(a.instance_id, b.instance_id);
  });
  EXPECT_GT(hits, 1000) << "the test has lost its power";
  expect_same_in_packets(*small);
  expect_same_in_packets(*large);
}

/// Returns the number of the instance at each position of a row along x, as seen from above.
std::vector<uint64_t> ids_seen(const Scene& scene, int count) {
  std::vector<uint64_t> ids;
  for (int i = 0; i < count; ++i) {
    SurfacePoint point;
    ids.push_back(scene.intersect({{float(i) * 3, 0, 9}, {0, 0, -1}}, 0, point) ? point.instance_id : 999);
  }
  return ids;
}

TEST_F(Instances, EveryCopyHasANumber) {
  const std::string objects = R"(
ObjectBegin "leaf" Shape "disk" ObjectEnd
ObjectBegin "pair" ObjectInstance "leaf" AttributeBegin Translate 3 0 0 ObjectInstance "leaf" AttributeEnd ObjectEnd
ObjectBegin "stalked" Shape "disk" AttributeBegin Translate 3 0 0 ObjectInstance "leaf" AttributeEnd ObjectEnd
)";
  EXPECT_EQ(ids_seen(*scene(objects + R"(Shape "disk"
Translate 3 0 0 ObjectInstance "pair" Translate 6 0 0 ObjectInstance "leaf" Translate 3 0 0 ObjectInstance "stalked"
Translate 6 0 0 ObjectInstance "pair")"),
                     8),
            (std::vector<uint64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(scene(objects)->geometry().instances(), 0u);
}

TEST_F(Instances, ATextureFollowsTheColumn) {
  InstanceWriter writer(file("leaves.npy"), 3, {"share"});
  for (int i = 0; i < 3; ++i)
    writer.add({{{{1, 0, 0, float(3 * i)}, {0, 1, 0, 0}, {0, 0, 1, 0}}}}, std::vector<float>{float(i) / 4});
  writer.finish();
  const auto made = scene(R"(
Texture "white" "float" "instance" "string column" "share" "float range" [0 .3] "float default" .1
Texture "paper" "spectrum" "scale" "spectrum tex" [300 1 900 1] "texture scale" "white"
Material "diffuse" "texture reflectance" "paper"
ObjectBegin "leaf" Shape "disk" ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
Translate 9 0 0 Shape "disk")");
  const std::array<float, 4> expected{0, 0.25f, 0.3f, 0.1f};  // the last but one beyond the range
  const SampledWavelengths lambda = made->wavelengths().sample(0.5f);
  for (size_t i = 0; i < expected.size(); ++i) {
    SurfacePoint point;
    ASSERT_TRUE(made->intersect({{float(i) * 3, 0, 9}, {0, 0, -1}}, 0, point));
    Arena arena;
    RandomStream random(1);
    const float f = point.material->evaluate(point.hit, lambda, arena)->f({0, 0, 1}, {0, 0, 1}, random)[0];
    EXPECT_NEAR(f * kPi, expected[i], 1e-5f) << i;
  }
}

TEST_F(Instances, AColumnThatNoTableHasIsAnError) {
  InstanceWriter writer(file("leaves.npy"), 1, {"chlorophyll"});
  writer.add({{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}}, std::vector<float>{3});
  writer.finish();
  const std::string texture =
      "Texture \"t\" \"float\" \"instance\" \"string column\" \"clorophyll\" \"float range\" [0 5]\n";
  const std::string leaves =
      "ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd\n"
      "Shape \"instances\" \"string object\" \"leaf\" \"string filename\" \"leaves.npy\"";
  EXPECT_THAT(
      error_of([&] { scene(texture + leaves); }),
      HasSubstr("scene.pbrt:3:48: no table of instances has a column \"clorophyll\"; did you mean \"chlorophyll\"?"));
  EXPECT_THAT(error_of([&] { scene(texture); }), HasSubstr("none has any numbers"));
}

}  // namespace
}  // namespace frond
