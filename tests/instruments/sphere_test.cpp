#include "instruments/sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/random.h"

namespace frond {
namespace {

constexpr double kSphere = 4 * std::numbers::pi;

/// Directions, most of them within a degree or so of one.
std::vector<Vec3> cluster(double cos_theta, uint64_t seed = 5) {
  const Frame frame = Frame::around(sphere_direction(cos_theta, 1.2));
  RandomStream numbers(seed);
  std::vector<Vec3> result;
  for (int i = 0; i < 4000; ++i)
    result.push_back(
        frame.to_world(sphere_direction(std::pow(numbers.uniform_double(), 1e-3), 6.28 * numbers.uniform())));
  return result;
}

TEST(SphereBins, CoverTheSphereOnce) {
  for (const double cos_theta : {1.0, 0.5, 0.01}) {
    const SphereBins bins(cluster(cos_theta), 64);
    double area = 0;
    for (size_t b = 0; b < bins.size(); ++b) area += bins.box(b).solid_angle();
    EXPECT_NEAR(area, kSphere, 1e-9);
  }
}

TEST(SphereBins, FindReturnsTheBinThatADirectionWasTakenFrom) {
  const SphereBins bins(cluster(0.5), 64);
  for (size_t b = 0; b < bins.size(); ++b) EXPECT_EQ(bins.find(bins.box(b).at(0.5, 0.5)), b);
}

TEST(SphereBins, HoldAboutEquallyManyDirections) {
  const auto directions = cluster(0.5);
  const SphereBins bins(directions, 64);
  std::vector<size_t> counts(bins.size(), 0);
  for (const Vec3& w : directions) ++counts[bins.find(w)];
  for (const size_t count : counts) EXPECT_LE(count, directions.size() / 64);
}

TEST(SphereBins, NoneCrossesTheHorizonOrIsLarge) {
  const SphereBins bins(cluster(0.01), 64);
  for (size_t b = 0; b < bins.size(); ++b) {
    EXPECT_GE(bins.box(b).z0 * bins.box(b).z1, 0);
    EXPECT_LE(bins.box(b).solid_angle(), kSphere / 16 + 1e-9);
  }
}

TEST(SphereBins, ManyEqualDirectionsEndTheCutting) {
  const SphereBins bins(std::vector<Vec3>(1000, sphere_direction(0.3, 2)), 10);
  EXPECT_LT(bins.size(), 100u);
}

}  // namespace
}  // namespace frond
