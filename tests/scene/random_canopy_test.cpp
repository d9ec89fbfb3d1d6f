// Random canopies: leaf angle distributions, and the positions of leaves.

#include "scene/geometry/random_canopy.h"

#include <gmock/gmock.h>

#include <numbers>

#include "instruments/errors/statistics.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

constexpr double kPiD = std::numbers::pi, kDegree = kPiD / 180;

/// The leaf area index and the mean projection of leaf normals, in closed form: G(vertical) = E|cos theta|.
TEST(RandomCanopy, LeavesHaveTheAnglesOfTheDistribution) {
  for (const LeafAngles& angles : leaf_angle_distributions()) {
    RandomCanopy canopy{.leaf_area_index = 2, .angles = &angles};
    canopy.seed = 3;
    EXPECT_EQ(canopy.leaves(), uint64_t(std::llround(200 / (std::numbers::pi * 0.0025))));
    LeafPlacer placer(canopy);
    constexpr int kLeaves = 20000;
    double sum = 0, squares = 0;
    for (int i = 0; i < kLeaves; ++i) {
      const AffineMap map = rounded_map(placer.place({}));
      const Vec3 normal = normalize(map.vector({0, 0, 1}));
      EXPECT_NEAR(length(map.vector({1, 0, 0})), 0.05f, 1e-6f);
      const double c = std::abs(double(normal.z));
      sum += c, squares += c * c;
    }
    double weight = 0, expected = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps && angles.density; ++i) {
      const double theta = (i + 0.5) * std::numbers::pi / 2 / kSteps;
      weight += angles.density(theta), expected += angles.density(theta) * std::cos(theta);
    }
    expected = angles.density ? expected / weight : 1;
    const double mean = sum / kLeaves, error = std::sqrt((squares / kLeaves - mean * mean) / kLeaves);
    EXPECT_LE(std::abs(mean - expected), 4.5 * error + 1e-6) << angles.name;  // false alarms: 7e-6 for each
  }
}

TEST(RandomCanopy, LeavesKeepTheMinimumDistance) {
  RandomCanopy canopy{.angles = &leaf_angle_distributions()[0]};
  canopy.count = 2000, canopy.ball = 1, canopy.apart = 0.1;
  LeafPlacer placer(canopy);
  std::vector<Vec3> middles;
  for (uint64_t i = 0; i < canopy.leaves(); ++i) middles.push_back(rounded_map(placer.place({})).translation());
  for (size_t i = 0; i < middles.size(); ++i) {
    EXPECT_LE(length(middles[i]), 1.00001f);
    for (size_t j = 0; j < i; ++j) ASSERT_GT(length(middles[i] - middles[j]), 0.09999f);
  }
  canopy.apart = 0.5;
  LeafPlacer crowded(canopy);
  EXPECT_THAT(error_of([&] {
                for (uint64_t i = 0; i < canopy.leaves(); ++i) crowded.place({});
              }),
              HasSubstr("there is no room for leaf"));
}

/// Campbell's closed form (1990): G = sqrt(chi^2 cos^2 + sin^2) / Lambda, whose denominator holds the ellipsoid's area.
double ellipsoidal_projection(double chi, double zenith) {
  double lambda = 2;
  if (chi < 1) {
    const double e = std::sqrt(1 - chi * chi);
    lambda = chi + std::asin(e) / e;
  } else if (chi > 1) {
    const double e = std::sqrt(1 - 1 / (chi * chi));
    lambda = chi + std::log((1 + e) / (1 - e)) / (2 * e * chi);
  }
  return std::hypot(chi * std::cos(zenith), std::sin(zenith)) / lambda;
}

TEST(LeafAngles, EllipsoidalOnesHaveCampbellsProjection) {
  for (const double chi : {0.02, 0.5, 1.0, 2.0, 50.0}) {
    const LeafAngles angles = ellipsoidal_angles(chi);
    double vertical = 0, sum = 0;
    for (int i = 0; i < LeafAngles::kSteps; ++i) {
      const double theta = (i + 0.5) * kPiD / 2 / LeafAngles::kSteps;
      sum += angles.share(i), vertical += angles.share(i) * std::cos(theta);
    }
    EXPECT_NEAR(vertical / sum, ellipsoidal_projection(chi, 0), 1e-6) << chi;
    EXPECT_NEAR(chi_of_mean(angles.mean()), chi, 1e-9 * chi);
  }
  EXPECT_NEAR(ellipsoidal_angles(1).mean(), 1, 1e-8);  // spherical: 1 radian
  // Campbell's approximation of the mean, 9.65 (3 + chi)^-1.65 radians, which he states for 0.1 to 10.
  for (const double chi : {0.1, 0.5, 3.0, 10.0})
    EXPECT_NEAR(ellipsoidal_angles(chi).mean(), 9.65 * std::pow(3 + chi, -1.65), 0.04) << chi;
  EXPECT_THAT(error_of([] { chi_of_mean(89.9 * kDegree); }), HasSubstr("between 0.904 and 89.6 degrees"));
}

/// Densities that are infinite at their ends, too.
TEST(LeafAngles, BetaOnesHaveTheirMean) {
  for (const auto& [mu, nu] : {std::pair(2.77, 1.17), {1.17, 2.77}, {1.0, 1.0}, {0.3, 0.2}, {0.05, 3.0}, {90.0, 40.0}})
    EXPECT_NEAR(beta_angles(mu, nu).mean() / kDegree, 90 * nu / (mu + nu), 0.002) << mu << " " << nu;
}

TEST(LeafAngles, TabulatedOnesAreLinearBetweenPoints) {
  const DensityTable table({{0, 0}, {0.5, 2}, {0.5, 1}, {1, 1}, {1, 0}, {1.5, 0}});
  EXPECT_DOUBLE_EQ(table.integral(), 1);
  EXPECT_DOUBLE_EQ(table.integral_to(0.25), 0.125);
  EXPECT_DOUBLE_EQ(table.integral_to(0.75), 0.75);
  EXPECT_DOUBLE_EQ(table.integral_to(9), 1);
  for (const double u : {0.0, 0.1, 0.5, 0.7, 0.999}) EXPECT_NEAR(table.integral_to(table.quantile(u)), u, 1e-12);
  EXPECT_NEAR(tabulated_angles("t", table).mean(), 0.5 * 2 / 3. * 0.5 + 0.5 * 0.75, 1e-6);
}

/// Leaves of a canopy by share of the position along an axis, in ten classes, against expected shares.
double p_of_shares(const RandomCanopy& canopy, const std::function<double(const Vec3&)>& share_below) {
  LeafPlacer placer(canopy);
  std::vector<double> observed(10), expected(10, double(canopy.leaves()) / 10);
  for (uint64_t i = 0; i < canopy.leaves(); ++i) {
    const double share = share_below(rounded_map(placer.place({})).translation());
    EXPECT_GE(share, -1e-6);
    EXPECT_LE(share, 1 + 1e-6);
    ++observed[std::min(size_t(std::max(0.0, share) * 10), size_t{9})];
  }
  return chi_square_p(observed, expected);
}

// Chi-square tests of 20,000 leaves, each with a false alarm of 1e-5.
constexpr double kLeastP = 1e-5;

TEST(RandomCanopy, ProfilesAndRowsHoldTheirSharesOfLeaves) {
  RandomCanopy canopy{.count = 20000, .angles = &leaf_angle_distributions()[0]};
  canopy.profile = DensityTable({{1, 0}, {2, 3}, {4, 1}});
  EXPECT_GT(p_of_shares(canopy, [&](const Vec3& p) { return canopy.profile->integral_to(double(p.z)) / 5.5; }),
            kLeastP);
  canopy.rows = {2, 0.5};
  const auto in_rows = [](const Vec3& p) {
    const double row = std::floor(double(p.x) / 2), across = (double(p.x) - 2 * row - 0.75) / 0.5;
    EXPECT_TRUE(across > -1e-5 && across < 1 + 1e-5) << p.x;
    return (row + across) / 5;
  };
  EXPECT_GT(p_of_shares(canopy, in_rows), kLeastP);
  EXPECT_GT(p_of_shares(canopy, [](const Vec3& p) { return double(p.y) / 10; }), kLeastP);
}

/// The share of a solid's volume below a point, by height and by distance from the axis.
TEST(RandomCanopy, CrownsAreFilledEvenly) {
  RandomCanopy canopy{.count = 20000, .angles = &leaf_angle_distributions()[0]};
  const Vec3d centre{1, -2, 5}, radii{2, 3, 4};
  const auto own = [&](const Vec3& p) {
    const Vec3d d = to_double(p) - centre;
    return Vec3d{d.x / radii.x, d.y / radii.y, d.z / radii.z};
  };
  const auto expect = [&](Crown::Shape shape, const std::function<double(const Vec3d&)>& share) {
    canopy.crowns = {{centre, radii, shape}};
    EXPECT_GT(p_of_shares(canopy, [&](const Vec3& p) { return share(own(p)); }), kLeastP) << int(shape);
  };
  using enum Crown::Shape;
  expect(ellipsoid, [](const Vec3d& q) { return std::pow(length(q), 3); });
  expect(ellipsoid, [](const Vec3d& q) { return (2 + 3 * q.z - q.z * q.z * q.z) / 4; });
  expect(cone, [](const Vec3d& q) { return std::pow((1 - q.z) / 2, 3); });
  expect(cone, [](const Vec3d& q) { return 4 * (q.x * q.x + q.y * q.y) / ((1 - q.z) * (1 - q.z)); });
  expect(cylinder, [](const Vec3d& q) { return q.x * q.x + q.y * q.y; });
  expect(cylinder, [](const Vec3d& q) { return (q.z + 1) / 2; });
}

TEST(RandomCanopy, CrownsHaveLeavesByVolumeAndDensity) {
  RandomCanopy canopy{.count = 1000, .angles = &leaf_angle_distributions()[0]};
  // Volumes 4/3 pi, 2/3 pi and 2 pi; areas 4 : 4 : 2.
  canopy.crowns = {{{0, 0, 0}, {1, 1, 1}, Crown::Shape::ellipsoid, 3},
                   {{10, 0, 0}, {1, 1, 1}, Crown::Shape::cone, 6},
                   {{20, 0, 0}, {1, 1, 1}, Crown::Shape::cylinder, 1}};
  LeafPlacer placer(canopy);
  std::array<int, 3> found{};
  for (int i = 0; i < 1000; ++i)
    ++found[size_t(std::lround(double(rounded_map(placer.place({})).translation().x) / 10))];
  EXPECT_EQ(found, (std::array{400, 400, 200}));
}

// 32-bit floats of coordinates of 4e6 are multiples of 0.5.
TEST(RandomCanopy, PositionsInMapCoordinatesAreExact) {
  RandomCanopy near{.count = 100, .angles = &leaf_angle_distributions()[0], .crowns = {{{0, 0, 0}, {1, 1, 1}}}};
  RandomCanopy far = near;
  far.crowns[0].centre = {500000, 4649776, 0};
  EXPECT_EQ(near.largest_position(), 1);
  EXPECT_EQ(far.largest_position(), 4649777);
  LeafPlacer near_placer(near), far_placer(far);
  for (int i = 0; i < 100; ++i) {
    const auto a = near_placer.place({}), b = far_placer.place({});
    EXPECT_NEAR(b[0][3] - 500000, a[0][3], 1e-9);
    EXPECT_NEAR(b[1][3] - 4649776, a[1][3], 1e-8);
  }
}

}  // namespace
}  // namespace frond
