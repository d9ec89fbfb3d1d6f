#include "instruments/sample_worth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/params.h"
#include "instruments/given_wavelengths.h"
#include "instruments/sweep.h"
#include "render/plugins.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

constexpr double kPi_d = std::numbers::pi;

/// Integral of a smooth function over [0, 1], by Simpson's rule.
double integral(const std::function<double(double)>& g) {
  constexpr int kSteps = 2000;
  double sum = g(0) + g(1);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * g(double(i) / kSteps);
  return sum / (3 * kSteps);
}

std::unique_ptr<Material> make(const std::string& name, const WavelengthStrategy& wavelengths) {
  static const Registry registry = load_registry({});
  const MaterialInfo& info = registry.materials.get(name, {});
  PlainResolver nothing([](const std::string&) { return nullptr; });
  auto material = info.make(Params(info, {}, nothing));
  ThreadPool pool(1);
  material->prepare({wavelengths, pool, silent_log(), {}});
  return material;
}

SampleWorth worth_of(const std::string& name, double theta_deg, int64_t samples, int threads = 2) {
  const GivenWavelengths wavelengths({608, 551, 455});
  const auto material = make(name, wavelengths);
  return measure_worth({*material, wavelengths.sample(0), theta_deg, 1}, samples, ThreadPool(threads));
}

/// Student's t of 64 batches: 7e-6 on both sides, so the dozen comparisons here fail by chance in fewer than 1e-4 of
/// all cases. The seed is fixed.
constexpr double kErrors = 4.9;

void expect_near(const Estimate& found, double expected, const char* what) {
  EXPECT_GT(found.standard_error(), 0) << what;
  EXPECT_LT(found.standard_error(), 0.005 * expected) << what;
  EXPECT_NEAR(found.mean, expected, kErrors * found.standard_error()) << what;
}

/// To rounding, unless a direction lies in the surface itself, as one of 2^23 does: this seed draws none.
TEST(SampleWorth, ALambertiansAlbedoTakesOneSample) {
  for (const double theta : {0., 80., 135.}) {
    const Worth albedo = worth_of("diffuse", theta, 10000).albedo;
    EXPECT_NEAR(albedo.mean.mean, 0.5, 1e-6);
    EXPECT_LT(albedo.variance.mean, 1e-13);
  }
}

/// By the cosine c of the light's sample, of density (1 + 2 c) / 2, and of the scattered ray, of density 2 c. Densities
/// in solid angle are (1 + 2 c) / (4 pi) and c / pi.
TEST(SampleWorth, ALambertianUnderTheSkyIsAsIntegralsSay) {
  constexpr double kAlbedo = 0.5;
  const auto weight = [](double c) {
    const double ratio = 4 * c / (1 + 2 * c);
    return 1 / (1 + ratio * ratio);
  };
  const auto light = [&](double c) { return kAlbedo * 12. / 7 * c * weight(c); };
  const auto scattered = [&](double c) { return kAlbedo * 3. / 7 * (1 + 2 * c) * (1 - weight(c)); };
  const auto mean_of = [](const auto& x, auto density, double power) {
    return integral([&](double c) { return std::pow(x(c), power) * density(c); });
  };
  const auto light_density = [](double c) { return (1 + 2 * c) / 2; };
  const auto ray_density = [](double c) { return 2 * c; };
  const double a = mean_of(light, light_density, 1), b = mean_of(scattered, ray_density, 1);
  ASSERT_NEAR(a + b, kAlbedo, 1e-9);
  const double variance = mean_of(light, light_density, 2) - a * a + mean_of(scattered, ray_density, 2) - b * b;
  const Worth sky = worth_of("diffuse", 45, 1000000).sky;
  expect_near(sky.mean, kAlbedo, "mean");
  expect_near(sky.variance, variance, "variance");
}

/// Practically by the light's sample alone: rho cos / mean cos, over a small cap that is even in area.
TEST(SampleWorth, ALambertianUnderTheSunVariesAsTheCosineOverTheDisc) {
  const double zenith = kSunZenith_deg * kPi_d / 180, least = std::cos(kSunRadius_deg * kPi_d / 180);
  const double mean = (1 + least) / 2, square = (1 + least + least * least) / 3;  // of cos alpha, cos^2 alpha
  const double of_cosine = std::cos(zenith) * std::cos(zenith) * (square - mean * mean) +
                           std::sin(zenith) * std::sin(zenith) * (1 - square) / 2;
  const double mean_cosine = std::cos(zenith) * mean;
  const Worth sun = worth_of("diffuse", 45, 1000000).sun;
  expect_near(sun.mean, 0.5, "mean");
  expect_near(sun.variance, 0.25 * of_cosine / (mean_cosine * mean_cosine), "variance");
}

/// R = T = 1/4; light comes from the front alone. 1e-5 has room for the one direction of 2^23 that scatters nothing.
TEST(SampleWorth, LightThatIsTransmittedIsSeenFromTheBack) {
  const SampleWorth front = worth_of("diffusetransmission", 45, 200000),
                    back = worth_of("diffusetransmission", 135, 200000);
  EXPECT_LT(front.albedo.variance.mean, 1e-5);
  expect_near(front.sky.mean, 0.25, "front");
  expect_near(back.sky.mean, 0.25, "back");
  expect_near(back.sun.mean, 0.25, "back");
  EXPECT_LT(worth_of("diffuse", 135, 1000).sky.mean.mean, 1e-12);
}

/// The walk's f is a random estimate, the solution's f is exact: both have the same mean, but different variances under
/// the sun.
TEST(SampleWorth, TheSunTellsARandomFFromAnExactOne) {
  const SampleWorth walk = worth_of("abm", 45, 200000), solved = worth_of("leaf_solved", 45, 20000);
  for (const auto worth : {&SampleWorth::albedo, &SampleWorth::sky, &SampleWorth::sun}) {
    const Estimate a = (walk.*worth).mean, b = (solved.*worth).mean;
    EXPECT_NEAR(a.mean, b.mean, 1e-3 * b.mean + kErrors * std::hypot(a.standard_error(), b.standard_error()));
  }
  EXPECT_GT(walk.sun.variance.mean, 100 * solved.sun.variance.mean);
}

TEST(SampleWorth, TheSameOnAnyNumberOfThreads) {
  const SampleWorth one = worth_of("leaf_simplified", 30, 2000, 1), two = worth_of("leaf_simplified", 30, 2000, 3);
  EXPECT_EQ(one.sky.variance.mean, two.sky.variance.mean);
  EXPECT_EQ(one.albedo.mean.variance, two.albedo.mean.variance);
}

TEST(SampleWorth, RefusesAPathAlongTheSurface) {
  EXPECT_THROW(worth_of("diffuse", 90, 100), InputError);
  EXPECT_THROW(worth_of("diffuse", 181, 100), InputError);
}

}  // namespace
}  // namespace frond
