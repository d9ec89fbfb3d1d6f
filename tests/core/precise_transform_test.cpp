#include "core/math/precise_transform.h"

#include <gtest/gtest.h>

#include "core/math/random.h"

namespace frond {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double slack) {
  EXPECT_NEAR(a.x, b.x, slack);
  EXPECT_NEAR(a.y, b.y, slack);
  EXPECT_NEAR(a.z, b.z, slack);
}

TEST(PreciseTransform, ComposesAsTransformDoes) {
  const PreciseTransform t = PreciseTransform::translate({1, 0, 0}) * PreciseTransform::scale({2, 2, 2});
  EXPECT_EQ(t.point({1, 1, 1}), (Vec3d{3, 2, 2}));
  EXPECT_EQ(t.vector({1, 1, 1}), (Vec3d{2, 2, 2}));
  EXPECT_EQ(t.inverse_point({3, 2, 2}), (Vec3d{1, 1, 1}));
  EXPECT_EQ(t.rounded(), Transform::translate({1, 0, 0}) * Transform::scale({2, 2, 2}));
}

TEST(PreciseTransform, KeepsMicrometresInMapCoordinates) {
  const Vec3d far{500000.123456, 5200000.654321, 312.5};
  const PreciseTransform t = PreciseTransform::translate(far) * PreciseTransform::rotate(36, {0.25, -0.87, 0.1}) *
                             PreciseTransform::translate({0.2, 0.3, 0.4});
  const Vec3d p = t.point({0.1, -0.1, 0.05});
  expect_near(t.inverse_point(p), {0.1, -0.1, 0.05}, 1e-8);
  const PreciseTransform near = PreciseTransform::translate(-far) * t;
  expect_near(near.point({0.1, -0.1, 0.05}), p - far, 1e-8);
}

TEST(PreciseTransform, CamerasInMapCoordinatesSeeTheSame) {
  const Vec3d far{500000, 5200000, 0}, eye{0.3, -2.1, 1.5}, target{0.1, 0.2, 0.2};
  const PreciseTransform here = PreciseTransform::look_at(eye, target, {0, 0, 1});
  const PreciseTransform there = PreciseTransform::look_at(eye + far, target + far, {0, 0, 1});
  expect_near((there * PreciseTransform::translate(far)).point({0.4, 0.5, 0.6}), here.point({0.4, 0.5, 0.6}), 1e-8);
}

TEST(PreciseTransform, StepsOfFloats) {
  EXPECT_EQ(float_spacing(5.2e6), 0.5);
  EXPECT_EQ(float_spacing(1), 0x1p-23);
  EXPECT_TRUE(is_far({0, -300, 0}));
  EXPECT_FALSE(is_far({256, -256, 0}));
}

}  // namespace
}  // namespace frond
