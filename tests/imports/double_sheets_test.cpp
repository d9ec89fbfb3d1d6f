#include "imports/double_sheets.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/parallel.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Sheet of n x n quadrilaterals over a unit square at height z, curved along x; `front` faces +z. The diagonals of the
/// quadrilaterals differ with `diagonal`.
PlantMesh sheet(double z, bool front, uint32_t material = 0, int n = 8, bool diagonal = false) {
  PlantMesh mesh{{}, "sheet", material};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const float x = float(i) / float(n), y = float(j) / float(n);
      mesh.p.push_back({x, y, float(z) + 0.1f * x * x});
    }
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    mesh.triangles.push_back(front ? std::array{a, b, c} : std::array{a, c, b});
  };
  for (uint32_t i = 0; i < uint32_t(n); ++i)
    for (uint32_t j = 0; j < uint32_t(n); ++j) {
      const uint32_t row = uint32_t(n) + 1, a = i * row + j, b = a + row, c = b + 1, d = a + 1;
      if (diagonal) {
        add(a, b, d), add(b, c, d);
      } else {
        add(a, b, c), add(a, c, d);
      }
    }
  return mesh;
}

std::vector<DoubleSheet> found(std::vector<PlantMesh> meshes, double tolerance = 0.002) {
  return double_sheets(meshes, tolerance, std::vector<bool>(2)).value();
}

/// One mesh of both.
PlantMesh joined(PlantMesh a, const PlantMesh& b) {
  const auto first = uint32_t(a.p.size());
  a.p.insert(a.p.end(), b.p.begin(), b.p.end());
  for (const auto& t : b.triangles) a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return a;
}

TEST(DoubleSheets, ASingleSheetIsNone) {
  EXPECT_THAT(found({sheet(0, true)}), IsEmpty());
  EXPECT_THAT(found({}), IsEmpty());
}

TEST(DoubleSheets, CoincidentFacesOfOneMeshOrTwoAreFound) {
  EXPECT_THAT(found({joined(sheet(0, true), sheet(0, false))}), ElementsAre(DoubleSheet{0, 128, 0}));
  EXPECT_THAT(found({sheet(0, true, 0), sheet(0, false, 1)}), ElementsAre(DoubleSheet{1, 128, 0}));
  EXPECT_THAT(found({sheet(0, true), sheet(0, false, 1, 8, true)}), ElementsAre(DoubleSheet{1, 128, 0}));
}

TEST(DoubleSheets, ParallelSheetsAreFoundWithTheirDistance) {
  const auto sheets = found({sheet(0, true), sheet(-0.001, false, 1, 6)});
  ASSERT_EQ(sheets.size(), 1u);
  EXPECT_EQ(sheets[0].triangles, 72u);
  EXPECT_NEAR(sheets[0].apart, 0.001, 0.0005);  // the curves are divided otherwise
  EXPECT_THAT(found({sheet(0, true), sheet(-0.01, false, 1)}), IsEmpty());
}

/// Leaves that lie on each other, both facing up, or that face each other, are two leaves.
TEST(DoubleSheets, OtherNeighboursAreNone) {
  EXPECT_THAT(found({sheet(0, true), sheet(0.001, true, 1)}), IsEmpty());
  EXPECT_THAT(found({sheet(0, true), sheet(0.001, false, 1)}), IsEmpty());
}

/// The opposite wall of a thin tube belongs to the same surface.
TEST(DoubleSheets, AThinTubeIsNone) {
  PlantMesh tube{{}, "tube"};
  constexpr uint32_t kSides = 12;
  for (uint32_t i = 0; i < kSides; ++i)
    for (const float z : {0.f, 1.f}) {
      const float angle = 2 * kPi * float(i) / kSides;
      tube.p.push_back({0.0005f * std::cos(angle), 0.0005f * std::sin(angle), z});
    }
  for (uint32_t i = 0; i < kSides; ++i) {
    const uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
    tube.triangles.push_back({a, b, b + 1});
    tube.triangles.push_back({a, b + 1, a + 1});
  }
  EXPECT_THAT(found({tube}), IsEmpty());
}

TEST(DoubleSheets, RemovalKeepsTheFirstSheetWhole) {
  std::vector<PlantMesh> meshes{joined(sheet(0, true), sheet(0, false)), sheet(2, true, 1), sheet(2, false, 1)};
  const auto sheets = double_sheets(meshes, 0.002, {true, false});
  EXPECT_THAT(*sheets, ElementsAre(DoubleSheet{0, 128, 0}, DoubleSheet{1, 128, 0}));
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_EQ(meshes[0].triangles, sheet(0, true).triangles);
  EXPECT_EQ(meshes[2].triangles.size(), 128u);
}

/// Triangles much larger than the median, which the search divides.
TEST(DoubleSheets, SizesMayDiffer) {
  EXPECT_THAT(found({sheet(0, true, 0, 1), joined(sheet(5, true, 0, 40), sheet(0, false, 0, 1))}),
              ElementsAre(DoubleSheet{0, 2, 0}));
}

/// The search would take hours if it depended on the ratio of the triangles' sizes, or compared equal ones.
TEST(DoubleSheets, SizesMayDifferByAMillionAndTrianglesBeEqual) {
  PlantMesh mesh{{}, "mesh"};
  mesh.p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 2, 0}, {2 + 1e-6f, 2, 0}, {2, 2 + 1e-6f, 0}, {1, 1, 1}};
  for (int i = 0; i < 100'000; ++i) {
    mesh.triangles.push_back({0, 1, 6});
    mesh.triangles.push_back({3, 4, 5});
  }
  EXPECT_THAT(found({mesh}, 1e-6), IsEmpty());
  for (int i = 0; i < 100'000; ++i) mesh.triangles.push_back({1, 0, 6});
  EXPECT_THAT(found({mesh}, 1e-6), ElementsAre(DoubleSheet{0, 100'000, 0}));
}

/// If all triangles hide each other, the search stops before it has compared every pair.
TEST(DoubleSheets, ASearchWithoutEndIsGivenUp) {
  std::vector<PlantMesh> meshes(2, PlantMesh{{}, "mesh"});
  for (uint32_t i = 0; i < 20'000; ++i)
    for (const bool front : {true, false}) {
      PlantMesh& mesh = meshes[front ? 0 : 1];
      const float y = 1 + 1e-6f * float(i);
      for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, y, 0}}) mesh.p.push_back(p);
      mesh.triangles.push_back(front ? std::array{3 * i, 3 * i + 1, 3 * i + 2}
                                     : std::array{3 * i, 3 * i + 2, 3 * i + 1});
    }
  const size_t before = meshes[1].triangles.size();
  EXPECT_FALSE(double_sheets(meshes, 0.002, {true, true}).has_value());
  EXPECT_EQ(meshes[1].triangles.size(), before);
}

TEST(DoubleSheets, TheSearchObservesTheStop) {
  std::stop_source stop;
  stop.request_stop();
  const StopScope scope(stop.get_token());
  std::vector<PlantMesh> meshes{sheet(0, true)};
  EXPECT_THROW(double_sheets(meshes, 0.002, {true, true}), Stopped);
}

}  // namespace
}  // namespace frond
