#include "instruments/spectrophotometer.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <limits>
#include <numbers>

#include "leaf/tissue/constants.h"
#include "leaf/tissue/fresnel.h"
#include "tests/instruments/specimen.h"
#include "tests/planted/planted.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

/// Chance that a sound program fails one test, for each test here.
constexpr double kFalseAlarmRate = 1e-6;

/// Weights are floats: relative rounding of their means.
constexpr double kFloat = 2e-7;

const ThreadPool kPool(2);

SpectrophotometerMeasurement measure(const LitMaterial& lit, int64_t rays) {
  return measure_shares(lit, {.rays = rays}, kPool);
}

/// Probability of these figures or less likely ones if the truth is `expected`.
double p_of(const Estimate& measured, double expected) { return equality_p(measured, {expected, 0, 0}, kFloat); }

TEST(Spectrophotometer, FindsTheReflectanceAndTransmittanceOfALambertianSurface) {
  const Prepared sheet("diffusetransmission", {level("reflectance", 0.3), level("transmittance", 0.55)}, 1000);
  const std::vector<double> angles{0, 8, 60, 89.9, 90, 120, 180};
  const double level = sidak_level(kFalseAlarmRate, 3 * angles.size());
  for (const double theta : angles) {
    const auto r = measure(sheet.under(theta), 100000);
    EXPECT_GT(p_of(r.reflectance, 0.3), level) << theta;
    EXPECT_GT(p_of(r.transmittance, 0.55), level) << theta;
    EXPECT_GT(p_of(r.absorptance, 0.15), level) << theta;
    EXPECT_FALSE(r.distinguishes_surface);
  }
}

TEST(Spectrophotometer, AbsorptanceKnowsThatReflectedRaysAreNotTransmitted) {
  // Every ray leaves with the same weight, one way or the other: A is known though R and T are not.
  const Prepared sheet("diffusetransmission", {level("reflectance", 0.5), level("transmittance", 0.25)}, 550);
  const auto r = measure(sheet.under(8), 10000);
  EXPECT_NEAR(r.absorptance.mean, 0.25, kFloat);
  EXPECT_LT(r.absorptance.standard_error(), kFloat);
  // Of 10,000 rays of weight 3/4, two thirds reflected.
  EXPECT_NEAR(r.reflectance.standard_error(), 0.75 * std::sqrt(2.0 / 9 / 10000), 1e-4);
}

// R / T of soybean at 8 degrees, solved from the same constants, for each side. The margin is theirs: 4 standard errors
// and 5e-5.
TEST(Spectrophotometer, MeasuresTheSoybeanLeaf) {
  struct Figure {
    double nm, theta, r, t;
  };
  for (const Figure& f : {Figure{455, 8, 0.04514, 0.01753},
                          {550, 8, 0.07592, 0.14742},
                          {605, 8, 0.05446, 0.10064},
                          {800, 8, 0.44167, 0.45604},
                          {455, 172, 0.21745, 0.01485},
                          {550, 172, 0.23045, 0.14498},
                          {605, 172, 0.21641, 0.09502},
                          {800, 172, 0.40437, 0.51735}}) {
    const auto m = measure(Prepared("abm", {}, f.nm).under(f.theta), 200000);
    EXPECT_NEAR(m.reflectance.mean, f.r, 4 * m.reflectance.standard_error() + 5e-5) << f.nm << ", " << f.theta;
    EXPECT_NEAR(m.transmittance.mean, f.t, 4 * m.transmittance.standard_error() + 5e-5) << f.nm << ", " << f.theta;
  }
}

TEST(Spectrophotometer, SurfaceReflectanceOfALeafIsFresnels) {
  const std::vector<double> angles{0, 30, 70, 110};
  for (const std::string name : {"abm", "leaf_simplified"}) {
    const Prepared leaf(
        name, name == "abm" ? std::vector<ParsedParam>() : std::vector<ParsedParam>{word("tablemethod", "solve")}, 551);
    for (const double theta : angles) {
      const auto m = measure(leaf.under(theta), 50000);
      ASSERT_TRUE(m.distinguishes_surface);
      const double fresnel =
          leaf::fresnel(std::abs(std::cos(theta * std::numbers::pi / 180)), 1 / leaf::constants_at(551).n_cuticle)
              .reflectance;
      // The simplified model's table is interpolated: 1e-4.
      EXPECT_GT(equality_p(m.surface, {fresnel, 0, 0}, 1e-4), sidak_level(kFalseAlarmRate, 2 * angles.size()))
          << name << ", " << theta;
      EXPECT_NEAR(m.reflectance.mean, m.surface.mean + m.subsurface.mean, 1e-12);
    }
  }
}

TEST(Spectrophotometer, AtNinetyDegreesALeafReflectsEverything) {
  const auto m = measure(Prepared("abm", {}, 551).under(90), 10000);
  EXPECT_NEAR(m.surface.mean, 1, 1e-5);
  EXPECT_NEAR(m.absorptance.mean, 0, 1e-5);
}

/// Sends a quarter of the rays on as a mirror does and swallows the others.
struct QuarterMirror final : Honest {
  explicit QuarterMirror(const SampledWavelengths& lambda) : Honest(lambda, 0, 0), one_(level(lambda, 1)) {}
  Lobes flags() const override { return Lobes::reflection | Lobes::specular; }
  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2, RandomStream&) const override {
    if (uc >= 0.25f) return {};
    return BsdfSample{one_ * (0.25f / std::abs(wo.z)), {-wo.x, -wo.y, wo.z}, 0.25f, flags()};
  }
  SampledSpectrum one_;
};

TEST(Spectrophotometer, MeasuresDeltaLobes) {
  const auto m = measure(Prepared(planted<QuarterMirror>("mirror"), {}, 551).under(30), 100000);
  EXPECT_GT(p_of(m.reflectance, 0.25), kFalseAlarmRate);
  EXPECT_EQ(m.transmittance.mean, 0);
}

/// Many short measurements of one thing.
std::vector<SpectrophotometerMeasurement> repeat(const Prepared& specimen, int times, int64_t rays) {
  std::vector<SpectrophotometerMeasurement> measurements;
  for (int seed = 1; seed <= times; ++seed) measurements.push_back(measure(specimen.under(8, uint64_t(seed)), rays));
  return measurements;
}

/// Two-sided p-value of "the stated variances are the variances of the means", by the spread of the means.
double spread_p(const std::vector<SpectrophotometerMeasurement>& measurements,
                Estimate SpectrophotometerMeasurement::*value) {
  Moments means, variances;
  for (const auto& r : measurements) means.add((r.*value).mean), variances.add((r.*value).variance);
  const double degrees = double(measurements.size()) - 1;
  const boost::math::chi_squared distribution(degrees);
  const double statistic = degrees * means.variance() / variances.mean();
  return 2 * std::min(cdf(distribution, statistic), cdf(complement(distribution, statistic)));
}

TEST(Spectrophotometer, StandardErrorsAreThoseOfRepeatedMeasurements) {
  for (const char* mode : {"analog", "weighted"}) {
    const auto measurements = repeat(Prepared("abm", {word("mode", mode)}, 551), 400, 2000);
    for (const auto value : {&SpectrophotometerMeasurement::surface, &SpectrophotometerMeasurement::subsurface,
                             &SpectrophotometerMeasurement::reflectance, &SpectrophotometerMeasurement::transmittance,
                             &SpectrophotometerMeasurement::absorptance})
      EXPECT_GT(spread_p(measurements, value), sidak_level(kFalseAlarmRate, 10)) << mode;
  }
}

void expect_same_bits(const Estimate& a, const Estimate& b) {
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.variance, b.variance);
}

TEST(Spectrophotometer, TheSameBitsOnAnyNumberOfThreads) {
  const Prepared leaf("abm", {word("mode", "weighted")}, 800);
  const int64_t rays = 5 * kRaysPerBlock + 1234;
  const auto one = measure_shares(leaf.under(30), {.rays = rays}, ThreadPool(1));
  for (const int threads : {2, 3}) {
    const auto many = measure_shares(leaf.under(30), {.rays = rays}, ThreadPool(threads));
    expect_same_bits(many.reflectance, one.reflectance);
    expect_same_bits(many.transmittance, one.transmittance);
    expect_same_bits(many.absorptance, one.absorptance);
  }
  EXPECT_NE(measure_shares(leaf.under(30, 1), {.rays = rays}, kPool).reflectance.mean, one.reflectance.mean);
}

TEST(Spectrophotometer, StopsAtTheStandardErrorAskedFor) {
  const Prepared leaf("abm", {}, 551);
  const RayBudget budget{.rays = 100'000'000, .standard_error = 5e-4};
  const auto m = measure_shares(leaf.under(8), budget, kPool);
  EXPECT_LE(m.standard_error(), budget.standard_error);
  // A is about 0.776: sqrt(A (1 - A) / rays) = 5e-4 takes 695,000 rays; rounds are whole blocks and a margin.
  EXPECT_GT(m.rays, 600'000);
  EXPECT_LT(m.rays, 900'000);
  // A measurement in rounds equals a measurement of as many rays at once.
  expect_same_bits(measure(leaf.under(8), m.rays).reflectance, m.reflectance);
}

TEST(Spectrophotometer, StopsAtTheNumberOfRays) {
  const auto m = measure_shares(Prepared("abm", {}, 551).under(8), {.rays = 100'001, .standard_error = 1e-6}, kPool);
  EXPECT_EQ(m.rays, 100'001);
  EXPECT_GT(m.standard_error(), 1e-6);
}

TEST(Spectrophotometer, AnOutcomeThatNoRayMetDoesNotEndTheMeasurement) {
  // Perfectly black: the standard error is 0 after any number of rays, but enough rays are traced to exclude a rare
  // event.
  const Prepared black("diffuse", {level("reflectance", 0)}, 551);
  const auto m = measure_shares(black.under(8), {.rays = 1'000'000, .standard_error = 1e-5}, kPool);
  EXPECT_GE(m.rays, 200'000);
}

TEST(Spectrophotometer, RefusesWhatCannotBeMeasured) {
  const Prepared sheet("diffuse", {}, 551);
  EXPECT_NE(error_of([&] { measure(sheet.under(180.5), 100); }), "");
  EXPECT_NE(error_of([&] { measure(sheet.under(-1), 100); }), "");
  EXPECT_NE(error_of([&] { measure(sheet.under(std::numeric_limits<double>::quiet_NaN()), 100); }), "");
  EXPECT_NE(error_of([&] { measure(sheet.under(8), 0); }), "");
  EXPECT_NE(error_of([&] { measure(sheet.under(8), 1); }), "");
}

struct NotANumber final : Honest {
  explicit NotANumber(const SampledWavelengths& lambda) : Honest(lambda, std::nanf(""), 0) { reflected_ = 1; }
};

struct NotThere final : Material {
  explicit NotThere(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};

TEST(Spectrophotometer, SaysSoWhenTheMaterialIsAtFault) {
  const Prepared broken(planted<NotANumber>("broken"), {}, 551);
  EXPECT_EQ(error_of([&] { measure(broken.under(8), 100); }),
            "the material has a defect: for light at 8 degrees and 551 nm it scatters a weight of nan, which is "
            "negative, infinite or "
            "not a number, or in a direction of no unit length");
  const MaterialInfo not_there{{"material", "not_there", "", "", {}}, make_material<NotThere>};
  EXPECT_NE(error_of([&] { measure(Prepared(not_there, {}, 551).under(8), 100); }), "");
}

SpectrophotometerMeasurement measure_as_rendered(const Prepared& specimen, double theta) {
  LitMaterial lit = specimen.under(theta);
  lit.as_rendered = true;
  return measure(lit, 200000);
}

TEST(Spectrophotometer, SeesWhatARendererShows) {
  const double rate = sidak_level(kFalseAlarmRate, 6);
  const Prepared sheet("diffusetransmission", {level("reflectance", 0.3), level("transmittance", 0.55)}, 1000);
  EXPECT_GT(p_of(measure_as_rendered(sheet, 120).reflectance, 0.3), rate);
  EXPECT_GT(p_of(measure_as_rendered(sheet, 120).transmittance, 0.55), rate);
  // A leaf without mesophyll conserves energy, if the light's direction is its incident direction.
  const ParsedParam clear = real("mesophyllfraction", 0);
  const Prepared light("abm", {clear, word("incident", "light")}, 551), traced("abm", {clear}, 551);
  for (const double theta : {5.0, 75.0}) {
    EXPECT_GT(p_of(measure_as_rendered(light, theta).absorptance, 0), rate) << theta;
    EXPECT_LT(p_of(measure_as_rendered(traced, theta).absorptance, 0), rate) << theta;
  }
}

}  // namespace
}  // namespace frond::test
