#include "instruments/errors/render_error.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace frond {
namespace {

constexpr size_t kPixels = 20000;
/// Each bound below fails by chance less than once in a million seeds.
constexpr double kErrorZ = 5;

struct Images {
  std::vector<float> a1, a2, r1, r2;
};

/// A candidate that is off by `bias` in every other pixel, with normal noise.
Images images(double bias, double noise, double reference_noise) {
  std::mt19937_64 rng(7);
  std::normal_distribution<double> normal;
  Images p;
  for (size_t i = 0; i < kPixels; ++i) {
    const double truth = 0.3 + 0.2 * std::sin(double(i)), off = i % 2 == 0 ? bias : 0;
    p.a1.push_back(float(truth + off + noise * normal(rng)));
    p.a2.push_back(float(truth + off + noise * normal(rng)));
    p.r1.push_back(float(truth + reference_noise * normal(rng)));
    p.r2.push_back(float(truth + reference_noise * normal(rng)));
  }
  return p;
}

RenderError error_of(const Images& p, std::span<const float> use = {}) {
  return render_error({p.a1, p.a2}, {p.r1, p.r2}, use);
}

void expect_near(const MeanSquare& m, double expected) {
  EXPECT_NEAR(m.value, expected, kErrorZ * m.standard_error);
  EXPECT_LT(m.standard_error, 0.1 * expected);
}

TEST(RenderError, TellsBiasFromNoiseAndFromTheReferencesNoise) {
  const RenderError e = error_of(images(0.04, 0.05, 0.03));
  const double bias = 0.04 * 0.04 / 2, noise = 0.05 * 0.05;
  expect_near(e.bias, bias);
  expect_near(e.noise, noise);
  expect_near(e.total, bias + noise);
  expect_near(e.reference_noise, 0.03 * 0.03 / 2);
  EXPECT_LT(e.clipped.value, e.total.value * 1.0001);
}

TEST(RenderError, OfAnUnbiasedMethodHasNoBiasButItsInterval) {
  const RenderError e = error_of(images(0, 0.05, 0.03));
  EXPECT_NEAR(e.bias.value, 0, kErrorZ * e.bias.standard_error);
  EXPECT_GT(e.bias.standard_error, 0);
}

TEST(RenderError, CountsThePixelsThatAreUsed) {
  const Images p = images(0.04, 0.001, 0.001);
  std::vector<float> even(kPixels), none(kPixels);
  for (size_t i = 0; i < kPixels; i += 2) even[i] = 1;
  expect_near(error_of(p, even).bias, 0.04 * 0.04);
  EXPECT_EQ(error_of(p, none).total.value, 0);
}

/// Over the true mean, 0.3: noise of either method does not change the relative figures.
TEST(RenderError, InUnitsOfTheReferencesMeanIsRelative) {
  const Images p = images(0.04, 0.05, 0.03);
  const RenderError e = in_unit(mean_of({p.r1, p.r2}), error_of(p));
  const double bias = 0.04 * 0.04 / 2, noise = 0.05 * 0.05, mean_squared = 0.3 * 0.3;
  expect_near(e.bias, bias / mean_squared);
  expect_near(e.noise, noise / mean_squared);
  expect_near(e.total, (bias + noise) / mean_squared);
  expect_near(e.reference_noise, 0.03 * 0.03 / 2 / mean_squared);
}

TEST(RenderError, AMeanIsOfBothRendersAndThePixelsThatAreUsed) {
  const std::vector<float> first{1, 2, 4}, second{3, 4, 8}, some{1, 1, 0}, none(3);
  EXPECT_DOUBLE_EQ(mean_of({first, second}), 11.0 / 3);
  EXPECT_DOUBLE_EQ(mean_of({first, second}, some), 2.5);
  EXPECT_EQ(mean_of({first, second}, none), 0);
}

TEST(RenderError, ChannelsTogetherAreTheirMean) {
  RenderError a, b;
  a.noise = {1, 0.1}, b.noise = {3, 0.3};
  const RenderError mean = mean_of(std::array{a, b});
  EXPECT_DOUBLE_EQ(mean.noise.value, 2);
  EXPECT_DOUBLE_EQ(mean.noise.standard_error, 0.2);  // as if they always erred together
}

TEST(RenderError, RepeatsAverageTheirErrors) {
  RenderError a, b;
  a.bias = {1, 0.3}, b.bias = {3, 0.4};
  const RenderError mean = mean_of_independent(std::array{a, b});
  EXPECT_DOUBLE_EQ(mean.bias.value, 2);
  EXPECT_DOUBLE_EQ(mean.bias.standard_error, 0.25);
}

}  // namespace
}  // namespace frond
