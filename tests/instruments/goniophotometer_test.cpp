#include "instruments/goniophotometer.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <numbers>

#include "instruments/cubature.h"
#include "instruments/spectrophotometer.h"
#include "tests/instruments/specimen.h"
#include "tests/planted/planted.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

constexpr double kFalseAlarmRate = 1e-6;

const ThreadPool kPool(2);

constexpr double kDegree = std::numbers::pi / 180;

TEST(DetectorSphere, PatchesCoverTheSphere) {
  for (const auto& [thetas, phis] : {std::pair{20, 40}, {2, 1}, {6, 7}, {180, 360}}) {
    const DetectorSphere sphere(thetas, phis);
    double solid = 0, projected = 0;
    for (size_t i = 0; i < sphere.size(); ++i) {
      solid += sphere.patch(i).solid_angle;
      projected += sphere.patch(i).projected_solid_angle;
    }
    EXPECT_NEAR(solid, 4 * std::numbers::pi, 1e-9);
    EXPECT_NEAR(projected, 2 * std::numbers::pi, 1e-9);
  }
}

bool contains(const Patch& p, double theta_deg, double phi_deg) {
  const bool in_theta = theta_deg >= p.theta_min_deg && theta_deg <= p.theta_max_deg;
  for (const double turn : {-360.0, 0.0, 360.0})
    if (in_theta && phi_deg + turn >= p.phi_min_deg && phi_deg + turn <= p.phi_max_deg) return true;
  return false;
}

TEST(DetectorSphere, FindsThePatchOfADirection) {
  RandomStream numbers(3);
  for (const auto& [thetas, phis] : {std::pair{20, 40}, {2, 1}, {6, 7}, {180, 360}, {2000, 3}}) {
    const DetectorSphere sphere(thetas, phis);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 w = SphereBox{}.at(numbers.uniform_double(), numbers.uniform_double());
      const SpherePoint p(w);
      const double theta = std::acos(p.cos_theta) / kDegree;
      ASSERT_TRUE(contains(sphere.patch(sphere.find(w)), theta, p.phi / kDegree)) << theta << ", " << p.phi / kDegree;
    }
  }
}

TEST(DetectorSphere, TheHorizonAndThePolesAreWhereTheyBelong) {
  const DetectorSphere sphere(20, 40);
  EXPECT_EQ(sphere.find({0, 0, 1}), sphere.index(0, 0));
  EXPECT_EQ(sphere.find({0, 0, -1}), sphere.index(19, 0));
  EXPECT_EQ(sphere.find({1, 0, 1e-30f}), sphere.index(9, 0));
  EXPECT_EQ(sphere.find({1, 0, -1e-30f}), sphere.index(10, 0));
  EXPECT_EQ(sphere.find({1, -1e-30f, 1e-30f}), sphere.index(9, 0));
  EXPECT_EQ(sphere.find({-1, 0, 1e-30f}), sphere.index(9, 20));
  EXPECT_EQ(sphere.find({-1, -1e-30f, 1e-30f}), sphere.index(9, 20));
}

TEST(DetectorSphere, RefusesPatchesThatMeanNothing) {
  EXPECT_NE(error_of([] { DetectorSphere(0, 40); }), "");
  EXPECT_NE(error_of([] { DetectorSphere(20, 0); }), "");
  EXPECT_NE(error_of([] { DetectorSphere(-2, 40); }), "");
  EXPECT_NE(error_of([] { DetectorSphere(19, 40); }), "");
  EXPECT_NE(error_of([] { DetectorSphere(2'000'000'000, 2'000'000'000); }), "");
}

SphereBox box_of(const Patch& p) {
  return {std::cos(p.theta_max_deg * kDegree), std::cos(p.theta_min_deg * kDegree), p.phi_min_deg * kDegree,
          p.phi_max_deg * kDegree};
}

/// Chi-square test of the detectors' counts against the integrals of f. All rays have equal weights.
void expect_agreement(const Prepared& specimen, double theta, const DetectorSphere& sphere, int64_t rays) {
  const LitMaterial lit = specimen.under(theta);
  const auto measurement = measure_f(lit, sphere, rays, kPool);
  const auto exact = integrate_f(lit, sphere, kPool);
  std::vector<double> observed, expected;
  double weight = 0;
  for (size_t i = 0; i < sphere.size(); ++i) {
    weight += exact.integral[i];
    observed.push_back(double(measurement.count(i)));
    expected.push_back(exact.integral[i] * double(rays));
  }
  double absorbed = double(rays);
  for (size_t i = 0; i < sphere.size(); ++i) {
    expected[i] /= weight;  // each ray carries all that is not absorbed
    absorbed -= observed[i];
  }
  EXPECT_EQ(absorbed, 0);
  EXPECT_GT(chi_square_p(observed, expected), kFalseAlarmRate) << theta;
  for (size_t i = 0; i < sphere.size(); ++i) {
    const Estimate f = measurement.f(i);
    const double count = observed[i], area = sphere.patch(i).projected_solid_angle;
    EXPECT_NEAR(f.mean, weight * count / (double(rays) * area), 1e-4 * f.mean + 1e-12);
  }
}

TEST(Goniophotometer, MeasuresALambertianSurface) {
  const Prepared sheet("diffusetransmission", {level("reflectance", 0.3), level("transmittance", 0.55)}, 1000);
  for (const double theta : {0.0, 45.0, 150.0}) expect_agreement(sheet, theta, DetectorSphere(20, 40), 300000);
  const auto measurement = measure_f(sheet.under(30), DetectorSphere(2, 1), 300000, kPool);
  EXPECT_GT(equality_p(measurement.f(0), {0.3 / std::numbers::pi, 0, 0}, 1e-6), kFalseAlarmRate);
  EXPECT_GT(equality_p(measurement.f(1), {0.55 / std::numbers::pi, 0, 0}, 1e-6), kFalseAlarmRate);
}

TEST(Goniophotometer, MeasuresALeafWithThreeLobes) {
  const Prepared leaf("leaf_simplified", {word("tablemethod", "solve")}, 551);
  for (const double theta : {30.0, 80.0, 135.0}) expect_agreement(leaf, theta, DetectorSphere(20, 40), 300000);
  expect_agreement(leaf, 45, DetectorSphere(12, 7), 300000);
}

// The walk's exitant light and the integral of its f are estimated independently: two-sample test in every patch.
TEST(Goniophotometer, AgreesWithTheWalksOwnF) {
  const Prepared leaf("abm", {}, 800);
  const LitMaterial lit = leaf.under(30);
  const DetectorSphere sphere(6, 6);
  const auto measurement = measure_f(lit, sphere, 200000, kPool);
  Arena arena;
  const Bsdf& bsdf = bsdf_of(lit.material, lit.beam, arena);
  for (size_t i = 0; i < sphere.size(); ++i) {
    RandomStream numbers(hash_key(5, i));
    const Patch patch = sphere.patch(i);
    Moments f;
    for (int n = 0; n < 3000; ++n) {
      const double a = numbers.uniform_open(), b = numbers.uniform_open();
      const Vec3 w = box_of(patch).at(a, b);
      f.add(double(bsdf.f(toward_light(lit.beam), w, numbers)[0] * std::abs(w.z)) * patch.solid_angle /
            patch.projected_solid_angle);
    }
    EXPECT_GT(equality_p(measurement.f(i), f.estimate(), 1e-6), sidak_level(kFalseAlarmRate, sphere.size())) << i;
  }
}

TEST(Goniophotometer, IntegratesALambertianSurface) {
  const Prepared sheet("diffusetransmission", {level("reflectance", 0.3), level("transmittance", 0.55)}, 1000);
  for (const double theta : {0.0, 45.0, 150.0}) {
    const auto measurement = integrate_f(sheet.under(theta), DetectorSphere(20, 40), kPool);
    EXPECT_TRUE(measurement.is_integrated());
    for (size_t i = 0; i < measurement.sphere.size(); ++i) {
      const bool reflected = measurement.is_reflected(measurement.sphere.patch(i));
      EXPECT_NEAR(measurement.f(i).mean, (reflected ? 0.3 : 0.55) / std::numbers::pi, 1e-6);
      EXPECT_EQ(measurement.f(i).variance, 0);
    }
    EXPECT_NEAR(measurement.share(true).mean, 0.3, 1e-6);
    EXPECT_NEAR(measurement.share(false).mean, 0.55, 1e-6);
  }
}

// Every narrow lobe is found, also if the incident direction of the model is reversed.
TEST(Goniophotometer, IntegratesWhatTheSolverKnows) {
  for (const char* incident : {"traced", "light"})
    for (const double theta : {0.0, 30.0, 80.0, 100.0}) {
      const Prepared leaf("leaf_simplified", {word("incident", incident), real("oblateness", 1000)}, 551);
      const auto measurement = integrate_f(leaf.under(theta), DetectorSphere(20, 40), kPool);
      const auto shares = measure_shares(leaf.under(theta), {.rays = 300000}, kPool);
      EXPECT_GT(equality_p({measurement.share(true).mean, 0, 0}, shares.reflectance, 1e-4), kFalseAlarmRate) << theta;
      EXPECT_GT(equality_p({measurement.share(false).mean, 0, 0}, shares.transmittance, 1e-4), kFalseAlarmRate)
          << theta;
    }
}

TEST(Goniophotometer, IntegratesAsRendered) {
  const Prepared leaf("leaf_solved", {}, 551);
  LitMaterial lit = leaf.under(60);
  const auto model = integrate_f(lit, DetectorSphere(6, 6), kPool);
  lit.as_rendered = true;
  const auto rendered = integrate_f(lit, DetectorSphere(6, 6), kPool);
  const auto rays = measure_f(lit, DetectorSphere(6, 6), 300000, kPool);
  for (size_t i = 0; i < rays.sphere.size(); ++i)
    EXPECT_GT(equality_p(rays.f(i), rendered.f(i), 1e-5), sidak_level(kFalseAlarmRate, rays.sphere.size())) << i;
  EXPECT_NE(model.f(0).mean, rendered.f(0).mean);
}

TEST(Goniophotometer, KnowsWhichFIsExact) {
  EXPECT_TRUE(has_exact_f(Prepared("leaf_solved", {}, 551).under(30)));
  EXPECT_FALSE(has_exact_f(Prepared("abm", {}, 551).under(30)));
}

TEST(Goniophotometer, PatchesAddUpToWhatTheSpectrophotometerMeasures) {
  const Prepared leaf("abm", {word("mode", "weighted")}, 551);
  const auto patches = measure_f(leaf.under(120), DetectorSphere(20, 40), 100000, kPool);
  const auto shares = measure_shares(leaf.under(120), {.rays = 100000}, kPool);
  double reflected = 0, transmitted = 0;
  for (size_t i = 0; i < patches.sphere.size(); ++i) {
    const Patch p = patches.sphere.patch(i);
    (patches.is_reflected(p) ? reflected : transmitted) += patches.f(i).mean * p.projected_solid_angle;
  }
  EXPECT_NEAR(reflected, shares.reflectance.mean, 1e-12);
  EXPECT_NEAR(transmitted, shares.transmittance.mean, 1e-12);
  EXPECT_NEAR(patches.share(true).mean, reflected, 1e-12);
  EXPECT_NEAR(patches.share(false).standard_error(), shares.transmittance.standard_error(), 1e-12);
}

TEST(Goniophotometer, StandardErrorsAreThoseOfRepeatedMeasurements) {
  constexpr int kTimes = 300;
  const Prepared leaf("abm", {word("mode", "weighted")}, 800);
  const DetectorSphere sphere(4, 6);
  std::vector<Moments> means(sphere.size()), variances(sphere.size());
  for (uint64_t seed = 1; seed <= kTimes; ++seed) {
    const auto measurement = measure_f(leaf.under(30, seed), sphere, 2000, kPool);
    for (size_t i = 0; i < sphere.size(); ++i)
      means[i].add(measurement.f(i).mean), variances[i].add(measurement.f(i).variance);
  }
  const boost::math::chi_squared distribution(kTimes - 1);
  for (size_t i = 0; i < sphere.size(); ++i) {
    const double statistic = (kTimes - 1) * means[i].variance() / variances[i].mean();
    const double p = 2 * std::min(cdf(distribution, statistic), cdf(complement(distribution, statistic)));
    EXPECT_GT(p, sidak_level(kFalseAlarmRate, sphere.size())) << i;
  }
}

TEST(Goniophotometer, TheSameBitsOnAnyNumberOfThreads) {
  const Prepared leaf("abm", {word("mode", "weighted")}, 800);
  const DetectorSphere sphere(20, 40);
  const int64_t rays = 5 * kRaysPerBlock + 77;
  const auto one = measure_f(leaf.under(30), sphere, rays, ThreadPool(1));
  const auto three = measure_f(leaf.under(30), sphere, rays, ThreadPool(3));
  for (size_t i = 0; i < sphere.size(); ++i) {
    ASSERT_EQ(one.f(i).mean, three.f(i).mean);
    ASSERT_EQ(one.f(i).variance, three.f(i).variance);
  }
}

TEST(Goniophotometer, RefusesADeltaLobe) {
  const Prepared coated(planted<GoodCoatedDiffuse>("coated"), {}, 551);
  EXPECT_NE(error_of([&] { integrate_f(coated.under(30), DetectorSphere(20, 40), kPool); }).find("delta lobe"),
            std::string::npos);
  EXPECT_NE(error_of([&] { measure_f(coated.under(30), DetectorSphere(20, 40), 100, kPool); }).find("delta lobe"),
            std::string::npos);
  const Prepared sheet("diffuse", {}, 551);
  EXPECT_NE(error_of([&] { measure_f(sheet.under(30), DetectorSphere(20, 40), 0, kPool); }), "");
  EXPECT_NE(error_of([&] { measure_f(sheet.under(-3), DetectorSphere(20, 40), 10, kPool); }), "");
}

}  // namespace
}  // namespace frond::test
