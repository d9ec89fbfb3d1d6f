// Long steps of loading a scene end when a stop is requested. The stop is requested before each call.

#include "media/sampled_grid.h"
#include "scene/geometry/geometry.h"
#include "shapes/subdivision.h"
#include "spectra/color/color_space.h"
#include "spectra/color/reflectance_table.h"
#include "tests/support/expect_stopped.h"
#include "textures/mip_map.h"

namespace frond {
namespace {

using test::expect_stopped;

/// A flat mesh of `side` x `side` squares.
std::shared_ptr<TriangleMesh> flat_mesh(uint32_t side) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (uint32_t y = 0; y <= side; ++y)
    for (uint32_t x = 0; x <= side; ++x) mesh->p.push_back({float(x), float(y), 0});
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t a = y * (side + 1) + x, b = a + side + 1;
      mesh->triangles.insert(mesh->triangles.end(), {{a, a + 1, b}, {a + 1, b + 1, b}});
    }
  return mesh;
}

TEST(Stop, EndsTheBuildOfATreeOfTriangles) {
  const auto build = [mesh = flat_mesh(300)] {
    ObjectParts world;
    world.surfaces.push_back({.geometry = mesh, .material = 0, .area_light = {}, .alpha = nullptr});
    return Geometry({}, std::move(world), 2).bounds();
  };
  EXPECT_FALSE(build().is_empty());
  expect_stopped(build);
  EXPECT_FALSE(build().is_empty());
}

TEST(Stop, EndsASubdivision) {
  const std::vector<Vec3> cage{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<std::array<uint32_t, 3>> faces{{4, 0, 2}, {4, 2, 1}, {4, 1, 3}, {4, 3, 0},
                                                   {5, 2, 0}, {5, 1, 2}, {5, 3, 1}, {5, 0, 3}};
  TriangleMesh mesh;
  expect_stopped([&] { (void)subdivide(cage, faces, 8, mesh); });
}

TEST(Stop, EndsTheLevelsOfATexture) {
  const Image image(512, 512, {"R", "G", "B"});
  expect_stopped([&] { MipMap(image, {}, true, {}); });
}

TEST(Stop, EndsTheMajorantsOfAGrid) {
  const SampledGrid<float> grid(std::vector<float>(20 * 20 * 20, 1.f), {20, 20, 20});
  expect_stopped([&] {
    MajorantGrid majorants(16);
    grid.fill_majorants(majorants, [](float v) { return v; });
  });
}

TEST(Stop, EndsATableOfReflectances) {
  expect_stopped([] { ReflectanceTable(*find_color_space("srgb")); });
}

}  // namespace
}  // namespace frond
