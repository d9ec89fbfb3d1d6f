#include "core/math/vec.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/math/random.h"
#include "core/math/sampling.h"

namespace frond {
namespace {

TEST(Vec3, CrossProductOfXAndYIsZ) { EXPECT_EQ(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}), (Vec3{0, 0, 1})); }

TEST(Vec3, NormalizeGivesUnitLength) {
  const Vec3d v = normalize(Vec3d{3, -4, 12});
  EXPECT_DOUBLE_EQ(length(v), 1);
  EXPECT_DOUBLE_EQ(v.y, -4.0 / 13);
}

TEST(Vec3, IndexMeansXYZ) {
  constexpr Vec3 v{1, 2, 3};
  EXPECT_EQ(v[0], 1);
  EXPECT_EQ(v[1], 2);
  EXPECT_EQ(v[2], 3);
}

/// Directions everywhere, both poles and their neighbourhood among them.
std::vector<Vec3d> directions() {
  std::vector<Vec3d> result{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 1, -0.0}};
  for (const double e : {1e-3, 1e-7, 1e-12})
    for (const double side : {-1.0, 1.0}) result.push_back(normalize(Vec3d{e, -e, side}));
  RandomStream numbers(7);
  for (int i = 0; i < 200; ++i)
    result.push_back(normalize(
        Vec3d{numbers.uniform_double() - 0.5, numbers.uniform_double() - 0.5, numbers.uniform_double() - 0.5}));
  return result;
}

TEST(Frame, IsRightHandedAndOrthonormalAroundEveryDirection) {
  for (const Vec3d& z : directions()) {
    const Framed f = Framed::around(z);
    EXPECT_EQ(f.z, z);
    EXPECT_NEAR(length(f.x), 1, 1e-14);
    EXPECT_NEAR(length(f.y), 1, 1e-14);
    EXPECT_NEAR(dot(f.x, f.y), 0, 1e-14);
    EXPECT_NEAR(dot(f.x, f.z), 0, 1e-14);
    EXPECT_NEAR(length(cross(f.x, f.y) - f.z), 0, 1e-14);
  }
}

TEST(Frame, LocalAndWorldUndoEachOther) {
  const Vec3d v{0.3, -0.2, 0.9};
  for (const Vec3d& z : directions()) {
    const Framed f = Framed::around(z);
    EXPECT_NEAR(length(f.to_world(f.to_local(v)) - v), 0, 1e-14);
    EXPECT_NEAR(length(f.to_local(z) - Vec3d{0, 0, 1}), 0, 1e-14);
  }
}

TEST(Vec3, NormalizesWhatFloatsHold) {
  for (const float size : {1e-42f, 1e-30f, 1e-12f, 1.f, 1e12f, 3e38f}) {
    const Vec3 n = normalize_any(Vec3{0, -size, size});
    EXPECT_NEAR(n.y, -std::sqrt(0.5f), 1e-6f) << size;
    EXPECT_NEAR(n.z, std::sqrt(0.5f), 1e-6f) << size;
  }
  EXPECT_EQ(normalize_any(Vec3{}), Vec3{});
}

TEST(Sampling, PowerHeuristicStandsOverflow) {
  EXPECT_EQ(power_heuristic(1e30f, 1e30f), 0.5f);
  EXPECT_EQ(power_heuristic(1, 1e30f), 0);
  EXPECT_EQ(power_heuristic(1e30f, 1), 1);
  EXPECT_EQ(power_heuristic(1, INFINITY), 0);
  EXPECT_EQ(power_heuristic(0, 0), 0);
}

}  // namespace
}  // namespace frond
