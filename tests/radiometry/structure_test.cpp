// Structure of scenes against closed forms.

#include "radiometry/structure.h"

#include <gmock/gmock.h>

#include <numbers>

#include "scene/format/parser.h"
#include "scene/geometry/instance_writer.h"
#include "scene/geometry/random_canopy.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

// Each comparison allows 4.5 standard errors, of the rays and of the positions of leaves: a false alarm of 7e-6 each,
// below 2e-3 for all of this file. Seeds are fixed.
constexpr double kZ = 4.5;
constexpr double kPiD = std::numbers::pi, kDegree = kPiD / 180;

/// Mean of |cos| between a direction and leaf normals, by integration over inclination and azimuth of the normals.
double projection(const LeafAngles& angles, double zenith) {
  if (!angles.density) return std::cos(zenith);
  constexpr int kAzimuths = 64, kStride = 64;
  double sum = 0, weights = 0;
  for (int i = kStride / 2; i < LeafAngles::kSteps; i += kStride) {
    const double alpha = (i + 0.5) * kPiD / 2 / LeafAngles::kSteps;
    double share = 0;
    for (int j = i - kStride / 2; j < i + kStride / 2; ++j) share += angles.share(j);
    double mean = 0;
    for (int k = 0; k < kAzimuths; ++k)
      mean += std::abs(std::cos(zenith) * std::cos(alpha) +
                       std::sin(zenith) * std::sin(alpha) * std::cos((k + 0.5) * 2 * kPiD / kAzimuths));
    sum += share * mean / kAzimuths, weights += share;
  }
  return sum / weights;
}

class Structure : public ::testing::Test {
 protected:
  StructureMeasurement measured(const std::string& world, const StructureRequest& request, uint64_t rays,
                                const std::string& options = "", int threads = 2) const {
    Session session(silent_log(), {threads, {}, {}});
    const auto path = folder_.write("scene.pbrt", options + "WorldBegin\n" + world);
    StructureMeter meter(session, parse_scene(path, silent_log()), request);
    meter.trace(rays, session.pool());
    return meter.read();
  }
  /// The leaves of a canopy as disks.
  std::string leaves(const RandomCanopy& canopy) const {
    LeafPlacer placer(canopy);
    InstanceWriter writer(folder_.name_of("leaves.npy"), canopy.leaves(), {});
    for (uint64_t i = 0; i < canopy.leaves(); ++i) writer.add(placer.place({}), {});
    writer.finish();
    return "MakeNamedMaterial \"leaf\" \"string type\" \"leaf_lambert\"\nNamedMaterial \"leaf\"\n"
           "ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd\n"
           "Shape \"instances\" \"string object\" \"leaf\" \"string filename\" \"leaves.npy\"\n";
  }

  TestFolder folder_{"structure"};
};

const std::string kPeriod = "Option \"float period\" [10 10]\n";
const LeafAngles& spherical() { return leaf_angle_distributions()[0]; }

/// Expects a value; `error` is the standard error besides the measurement's.
void expect_near(const MeanError& value, double expected, double error, const std::string& what) {
  EXPECT_LE(std::abs(value.mean - expected), kZ * std::hypot(value.standard_error, error))
      << what << ": " << value.mean << " +- " << value.standard_error << ", " << expected << " expected";
}

/// Gap fraction and sunlit fraction of leaves at random by Beer's law; G is integrated.
TEST_F(Structure, LeavesAtRandomObeyBeersLaw) {
  std::vector<LeafAngles> all(leaf_angle_distributions().begin(), leaf_angle_distributions().end());
  all.push_back(ellipsoidal_angles(chi_of_mean(70 * kDegree)));
  all.push_back(beta_angles(0.7, 0.6));
  all.push_back(tabulated_angles("table", DensityTable({{0, 1}, {0.5, 0}, {1, 3}, {kPiD / 2, 1}})));
  constexpr double kLai = 1;
  constexpr uint64_t kLeaves = 60000;
  for (const LeafAngles& angles : all) {
    RandomCanopy canopy{.leaf_area_index = kLai, .angles = &angles};
    canopy.scale = std::sqrt(kLai * 100 / (kPiD * double(kLeaves)));
    canopy.seed = 11;
    const StructureMeasurement m = measured(leaves(canopy), {.zeniths_deg = {20, 45, 65}}, 40000, kPeriod);
    expect_near(m.leaf_area_index, kLai, 1e-5, angles.name);
    for (const auto& d : m.directions) {
      const double g = projection(angles, d.zenith_deg * kDegree), cosine = std::cos(d.zenith_deg * kDegree);
      const double depth = g * kLai / cosine, gap = std::exp(-depth), sunlit = (1 - gap) / depth;
      // Of the overlap of leaves: the variance of sums over leaves of their shadows, relative to the plot; |cos|^2 <
      // |cos| bounds it.
      const double error = kLai / cosine * std::sqrt(g / double(kLeaves));
      const std::string what = fmt::format("{} at {}", angles.name, d.zenith_deg);
      expect_near(d.gap, gap, error * gap, what);
      expect_near(d.projection, g, std::sqrt(g * (1 - g) / double(kLeaves)), what);
      expect_near(d.sunlit, sunlit, error * sunlit, what);
      expect_near(d.clumping, 1, error / depth, what);
    }
  }
}

/// A tilted rectangle over soil, which does not stop rays: everything is exact.
TEST_F(Structure, OneRectangleHasItsOwnAreaAngleAndShadow) {
  const std::string soil =
      "LightSource \"distant\" \"point3 from\" [1 0 1] \"point3 to\" [0 0 0]\n"
      "MakeNamedMaterial \"soil\" \"string type\" \"diffuse\" NamedMaterial \"soil\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 10 0  10 10 0]\n";
  const std::string rectangle =
      "MakeNamedMaterial \"leaf\" \"string type\" \"leaf_lambert\" NamedMaterial \"leaf\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [4 4 1  6 4 3  4 6 1  6 6 3]\n";  // 45 degrees, facing -x
  const StructureMeasurement m =
      measured(soil + rectangle, {.zeniths_deg = {0, 30}, .azimuths_deg = {0, 90, 180}}, 20000, kPeriod);
  const double area = 4 * std::numbers::sqrt2;
  EXPECT_NEAR(m.leaf_area_index.mean, area / 100, 1e-6);
  EXPECT_NEAR(m.leaf_area_index.standard_error, 0, 1e-6);
  EXPECT_NEAR(m.mean_angle_deg.mean, 45, 1e-4);
  EXPECT_NEAR(m.sun_deg.value()[0], 45, 1e-3);
  EXPECT_NEAR(m.sunlit.mean, 1, 1e-12);  // edge on: nothing shades it
  for (const auto& d : m.directions) {
    const double theta = d.zenith_deg * kDegree, phi = d.azimuth_deg * kDegree;
    const double g = std::abs(-std::sin(theta) * std::cos(phi) + std::cos(theta)) / std::numbers::sqrt2;
    EXPECT_NEAR(d.projection.mean, g, 1e-5);
    expect_near(d.gap, 1 - g * area / 100 / std::cos(theta), 0, fmt::format("{} {}", d.zenith_deg, d.azimuth_deg));
    EXPECT_EQ(d.sunlit.mean, 1);
  }
  // The column of half of the rectangle, and of two periods.
  const auto index = [&](const Target& target) {
    return measured(soil + rectangle, {.zeniths_deg = {0}, .target = target}, 20000, kPeriod).leaf_area_index;
  };
  expect_near(index({0, 5, 0, 10, 5}), area / 100, 0, "half");
  EXPECT_NEAR(index({-7, 13, 0, 10, 5}).mean, area / 100, 1e-6);
}

/// Crowns in a plot without repetition: rays outside their shadows are free. The mean of exp(-tau chord) over the
/// shadow is a closed form for each shape, with tau the mean contacts per length.
TEST_F(Structure, CrownsHaveTheGapsOfTheirShapes) {
  constexpr uint64_t kLeaves = 40000;
  constexpr double kRadius = 1, kHalf = 1.5, kContacts = 2;  // along the middle
  struct Case {
    Crown::Shape shape;
    double volume, mean_gap;
  };
  const double t = kContacts, e = std::exp(-t);
  const Case cases[] = {{Crown::Shape::ellipsoid, 4 * kPiD / 3, 2 / (t * t) * (1 - (1 + t) * e)},
                        {Crown::Shape::cone, 2 * kPiD / 3, 2 / (t * t) * (t - 1 + e)},
                        {Crown::Shape::cylinder, 2 * kPiD, e}};
  for (const Case& c : cases) {
    // Spherical leaves: G = 1/2; contacts along the height 2 * kHalf are G * density * height.
    const double area = kContacts / kHalf * c.volume * kRadius * kRadius * kHalf;
    RandomCanopy canopy{.count = kLeaves, .angles = &spherical(), .scale = std::sqrt(area / double(kLeaves) / kPiD)};
    canopy.crowns = {{{0, 0, kHalf}, {kRadius, kRadius, kHalf}, c.shape}};
    canopy.seed = 3;
    const StructureMeasurement m =
        measured(leaves(canopy), {.zeniths_deg = {0}, .target = Target{-2, 2, -2, 2, 4}}, 200000);
    const double gap = 1 - kPiD / 16 * (1 - c.mean_gap);
    expect_near(m.leaf_area_index, area / 16, 1e-5 * area, "area");
    // Leaves that reach beyond the crown's edge by up to 1.5 % of its radius widen the shadow, less where chords are
    // short.
    EXPECT_NEAR(m.directions[0].gap.mean, gap, kZ * m.directions[0].gap.standard_error + 0.003) << int(c.shape);
  }
}

/// Balls of leaves that lie at random, each with Beer's law inside: the gap fraction of K independent balls, whose
/// shadows have the area pi r^2 / cos, is that of one to the power K.
TEST_F(Structure, LeavesInBallsAreClumped) {
  constexpr size_t kBalls = 200;
  constexpr double kRadius = 0.5, kContacts = 1.5;  // along the diameter
  const double density = kContacts / (0.5 * 2 * kRadius);
  const double area = density * double(kBalls) * 4 * kPiD / 3 * kRadius * kRadius * kRadius;
  double mean_gap = 0;
  constexpr int kPlots = 4;
  std::vector<StructureMeasurement> plots;
  for (uint64_t seed = 0; seed < kPlots; ++seed) {
    RandomCanopy canopy{.count = kBalls * 300, .angles = &spherical()};
    canopy.scale = std::sqrt(area / double(canopy.count) / kPiD);
    canopy.seed = seed;
    RandomStream random(hash_key(seed, uint64_t{7}));
    for (size_t i = 0; i < kBalls; ++i) {
      const double x = 10 * random.uniform_double(), y = 10 * random.uniform_double();
      canopy.crowns.push_back({{x, y, 1 + 4 * random.uniform_double()}, {kRadius, kRadius, kRadius}});
    }
    plots.push_back(measured(leaves(canopy), {.zeniths_deg = {0, 40, 60}}, 20000, kPeriod));
  }
  for (size_t d = 0; d < 3; ++d) {
    const double cosine = std::cos(plots[0].directions[d].zenith_deg * kDegree);
    const double t = kContacts, inside = 2 / (t * t) * (1 - (1 + t) * std::exp(-t));
    const double shadow = kPiD * kRadius * kRadius / (100 * cosine);
    mean_gap = std::pow(1 - shadow * (1 - inside), double(kBalls));
    double sum = 0, squares = 0, clumping = 0;
    for (const StructureMeasurement& m : plots) {
      const double gap = m.directions[d].gap.mean;
      sum += gap / kPlots, squares += gap * gap / kPlots, clumping += m.directions[d].clumping.mean / kPlots;
    }
    // Of the positions: the variance of the sum over balls of their attenuation relative to the plot, as of leaves.
    const double error = mean_gap * std::sqrt(double(kBalls) * shadow * (1 - inside) * shadow / kPlots);
    EXPECT_NEAR(sum, mean_gap, kZ * std::hypot(error, 0.5 / std::sqrt(20000. * kPlots))) << d;
    const double expected = -std::log(mean_gap) * cosine / (0.5 * area / 100);
    EXPECT_NEAR(clumping, expected, 0.1 * expected) << d;
    EXPECT_LT(clumping, 0.8) << d;
  }
}

/// Seen from above and along the rows, a row is a layer of its share of the plot.
TEST_F(Structure, RowsHaveTheGapsBetweenThem) {
  constexpr double kLai = 1.5, kShare = 0.4;
  RandomCanopy canopy{.leaf_area_index = kLai, .angles = &spherical(), .scale = 0.02};
  canopy.rows = {1, kShare};
  canopy.profile = DensityTable({{0.1, 0}, {0.5, 2}, {0.5, 1}, {1, 1}});
  canopy.seed = 5;
  const StructureMeasurement m =
      measured(leaves(canopy), {.zeniths_deg = {0, 30, 60}, .azimuths_deg = {90}}, 40000, kPeriod);
  for (const auto& d : m.directions) {
    const double cosine = std::cos(d.zenith_deg * kDegree), depth = 0.5 * kLai / kShare / cosine;
    // Leaves reach beyond the row's edges by up to 0.02, on average by a quarter of their diameter.
    EXPECT_NEAR(d.gap.mean, 1 - kShare + kShare * std::exp(-depth), kZ * d.gap.standard_error + 0.01) << d.zenith_deg;
    expect_near(d.projection, 0.5, 0.29 / std::sqrt(double(canopy.leaves())), "G");
  }
}

TEST_F(Structure, ResultsDependOnSeedAndRaysAlone) {
  RandomCanopy canopy{.leaf_area_index = 1, .angles = &spherical(), .scale = 0.3};
  const std::string world = leaves(canopy);
  const StructureRequest request{.zeniths_deg = {0, 50}};
  const StructureMeasurement one = measured(world, request, 1 << 14, kPeriod, 1);
  const StructureMeasurement two = measured(world, request, 1 << 14, kPeriod, 3);
  Session session(silent_log(), {2, {}, {}});
  StructureMeter meter(session, parse_scene(folder_.name_of("scene.pbrt"), silent_log()), request);
  meter.trace(1 << 13, session.pool()), meter.trace(1 << 13, session.pool());
  for (const StructureMeasurement& other : {two, meter.read()})
    for (size_t d = 0; d < 2; ++d) {
      EXPECT_EQ(one.directions[d].gap.mean, other.directions[d].gap.mean);
      EXPECT_EQ(one.directions[d].projection.mean, other.directions[d].projection.mean);
      EXPECT_EQ(one.directions[d].sunlit.mean, other.directions[d].sunlit.mean);
    }
  EXPECT_NE(one.directions[0].gap.mean, measured(world, request, 1 << 13, kPeriod).directions[0].gap.mean);
}

/// A map that stretches, and alpha, change areas and normals.
TEST_F(Structure, StretchedAndCutLeavesHaveTheAreaThatIsLeft) {
  const std::string leaf = "Material \"leaf_lambert\"\n";
  const StructureMeasurement stretched =
      measured(leaf + "ObjectBegin \"ball\" Shape \"sphere\" ObjectEnd\nScale 1 1 2 ObjectInstance \"ball\"\n",
               {.zeniths_deg = {0}, .sun_deg = std::array{0.0, 0.0}, .target = Target{-2, 2, -2, 2, 3}}, 100000);
  // A prolate spheroid of the half axes 1 and 2: 2 pi (1 + 2 asin(e) / e), e^2 = 3/4. Its upper half is lit.
  const double e = std::sqrt(0.75), area = 2 * kPiD * (1 + 2 * std::asin(e) / e);
  expect_near(stretched.leaf_area_index, area / 16, 0, "spheroid");
  expect_near(stretched.directions[0].gap, 1 - kPiD / 16, 0, "spheroid");
  expect_near(stretched.directions[0].projection, 2 * kPiD / area, 0, "both sides of its shadow");
  expect_near(stretched.sunlit, 0.5, 0, "upper half");
  const StructureMeasurement cut = measured(leaf + "Shape \"disk\" \"float radius\" 1 \"float alpha\" 0.25\n",
                                            {.zeniths_deg = {0}, .target = Target{-1, 1, -1, 1, 1}}, 40000);
  expect_near(cut.leaf_area_index, 0.25 * kPiD / 4, 0, "alpha");
  expect_near(cut.directions[0].gap, 1 - 0.25 * kPiD / 4, 0, "alpha");
}

TEST_F(Structure, WhatCountsAsALeafIsNamed) {
  const std::string world =
      "MakeNamedMaterial \"soil\" \"string type\" \"diffuse\" NamedMaterial \"soil\" Shape \"disk\"\n"
      "MakeNamedMaterial \"green\" \"string type\" \"diffusetransmission\" NamedMaterial \"green\"\n"
      "Shape \"disk\" \"float radius\" 0.5 \"float height\" 1\n";
  const auto error = [&](const std::vector<std::string>& materials) {
    return error_of([&] { measured(world, {.zeniths_deg = {0}, .materials = materials}, 64); });
  };
  EXPECT_THAT(error({}), HasSubstr("no material of the scene is a leaf model: name the leaves by \"material\"; "
                                   "there are \"diffuse\", \"green\", \"soil\""));
  EXPECT_THAT(error({"gren"}), HasSubstr("the scene has no material \"gren\"; did you mean \"green\"?"));
  const StructureMeasurement m = measured(world, {.zeniths_deg = {0}, .materials = {"green"}}, 20000);
  EXPECT_NEAR(m.leaf_area_index.mean, kPiD / 4 / 4, 1e-5);
  EXPECT_TRUE(std::isnan(m.sunlit.mean));
}

}  // namespace
}  // namespace frond
