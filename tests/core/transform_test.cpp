#include "core/math/transform.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/math/random.h"

namespace frond {
namespace {

constexpr float kEpsilon = std::numeric_limits<float>::epsilon();

void expect_near(const Vec3& a, const Vec3& b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

Vec3 random_point(RandomStream& rng) { return {rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f}; }

TEST(Transform, IsIdentityUnlessToldOtherwise) {
  const Transform t;
  EXPECT_EQ(t.point({1, 2, 3}), (Vec3{1, 2, 3}));
  EXPECT_EQ(t.normal({1, 2, 3}), (Vec3{1, 2, 3}));
  EXPECT_TRUE(t.is_valid());
  EXPECT_FALSE(t.swaps_handedness());
}

TEST(Transform, TranslatesPointsAndLeavesVectors) {
  const Transform t = Transform::translate({1, 2, 3});
  EXPECT_EQ(t.point({1, 1, 1}), (Vec3{2, 3, 4}));
  EXPECT_EQ(t.vector({1, 1, 1}), (Vec3{1, 1, 1}));
  EXPECT_EQ(t.inverse().point({2, 3, 4}), (Vec3{1, 1, 1}));
}

TEST(Transform, RotatesByTheRightHandRule) {
  expect_near(Transform::rotate(90, {0, 0, 2}).vector({1, 0, 0}), {0, 1, 0}, kEpsilon);
  expect_near(Transform::rotate(90, {1, 0, 0}).vector({0, 1, 0}), {0, 0, 1}, kEpsilon);
  expect_near(Transform::rotate(120, {1, 1, 1}).vector({1, 0, 0}), {0, 1, 0}, 2 * kEpsilon);
}

TEST(Transform, AppliesTheRightHandSideOfAProductFirst) {
  const Transform t = Transform::translate({1, 0, 0}) * Transform::scale({2, 2, 2});
  EXPECT_EQ(t.point({1, 1, 1}), (Vec3{3, 2, 2}));
  EXPECT_EQ(t.inverse().point({3, 2, 2}), (Vec3{1, 1, 1}));
}

TEST(Transform, InverseUndoesARandomChain) {
  RandomStream rng(7);
  for (int i = 0; i < 200; ++i) {
    Transform t;
    for (int step = 0; step < 4; ++step)
      t = t * Transform::rotate(360 * rng.uniform_double(), random_point(rng)) *
          Transform::scale(random_point(rng) + Vec3{1, 1, 1}) * Transform::translate(random_point(rng));
    const Vec3 p = random_point(rng);
    // Factors of the chain are within [0.5, 1.5]: a condition of at most 81, over about 30 rounded operations.
    expect_near(t.inverse().point(t.point(p)), p, 81 * 30 * kEpsilon);
  }
}

TEST(Transform, KeepsNormalsNormalToTheirSurface) {
  RandomStream rng(8);
  for (int i = 0; i < 200; ++i) {
    const Transform t = Transform::rotate(360 * rng.uniform_double(), random_point(rng)) *
                        Transform::scale(random_point(rng) + Vec3{1, 1, 1});
    const Vec3 a = random_point(rng), b = random_point(rng);
    const Vec3 n = t.normal(cross(a, b));
    EXPECT_NEAR(dot(n, t.vector(a)), 0, 40 * kEpsilon);
    EXPECT_NEAR(dot(n, t.vector(b)), 0, 40 * kEpsilon);
  }
}

TEST(Transform, KnowsAMirror) {
  EXPECT_TRUE(Transform::scale({-1, 1, 1}).swaps_handedness());
  EXPECT_FALSE(Transform::scale({-1, -1, 1}).swaps_handedness());
  EXPECT_FALSE(Transform::rotate(70, {1, 2, 3}).swaps_handedness());
  EXPECT_FALSE(Transform::look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0}).swaps_handedness());
}

TEST(Transform, LooksAlongZAndTakesTheWorldForLeftHanded) {
  const Transform camera_from_world = Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  expect_near(camera_from_world.point({0, 0, 5}), {0, 0, 0}, 0);
  expect_near(camera_from_world.point({0, 0, 0}), {0, 0, 5}, 0);
  // Camera +x is the right of the image: in a left-handed world with y up, seen from +z, that is -x.
  expect_near(camera_from_world.point({-1, 0, 0}), {1, 0, 5}, 0);
  expect_near(camera_from_world.point({0, 1, 0}), {0, 1, 5}, 0);
}

TEST(Transform, TellsWhenItHasNoInverse) {
  EXPECT_FALSE(Transform::scale({1, 0, 1}).is_valid());
  EXPECT_FALSE(Transform::rotate(30, {0, 0, 0}).is_valid());
  EXPECT_FALSE(Transform::look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}).is_valid());
  EXPECT_FALSE(Transform::look_at({0, 0, 0}, {0, 2, 0}, {0, 1, 0}).is_valid());
  EXPECT_FALSE(Transform({{{0.1, 0.2, 0.3, 0}, {0.2, 0.4, 0.6, 0}, {1, 0, 2, 0}}}).is_valid());
  EXPECT_TRUE(Transform::scale({1e-6f, 1, 1e6f}).is_valid());
  const Transform tiny = Transform::scale({1e-30f, 1e-30f, 1e-30f});
  EXPECT_TRUE(tiny.is_valid());
  EXPECT_FALSE((tiny * tiny).is_valid());
}

}  // namespace
}  // namespace frond
