#include "instruments/paired_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace frond {
namespace {

/// Off by `bias` in the first channel of every other pixel, with normal noise of its own in each half.
PairedDifference difference(double bias, double noise, unsigned seed, size_t pixels = 20000) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  PairedDifference d{{}, 3};
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c)
      for (auto& half : d.half) half.push_back(float((c == 0 && i % 2 == 0 ? bias : 0) + noise * normal(rng)));
  return d;
}

/// Each bound below fails by chance less than once in a million seeds.
constexpr double kZ = 5;

TEST(PairedDifference, NoiseAveragesOutOfTheMeanSquare) {
  const Estimate e = mean_square(difference(0.03, 0.1, 1));
  EXPECT_NEAR(e.mean, 0.03 * 0.03 / 6, kZ * e.standard_error());
  EXPECT_LT(e.standard_error(), 6e-5);
}

TEST(PairedDifference, SpreadAmongPixelsIsUncertaintyToo) {
  const Estimate e = mean_square(difference(0.03, 0, 1));
  EXPECT_NEAR(e.mean, 0.03 * 0.03 / 6, 1e-9);
  EXPECT_NEAR(e.standard_error(), 0.03 * 0.03 / 3 / 2 / std::sqrt(20000), 1e-8);
}

TEST(PairedDifference, ProductsAreThoseOfTheBiases) {
  const PairedDifference a = difference(0.03, 0.02, 1), b = difference(-0.06, 0.02, 2);
  EXPECT_NEAR(mean_product(a, b), -0.03 * 0.06 / 6, 1.5e-5);
  EXPECT_DOUBLE_EQ(mean_product(a, a), mean_square(a).mean);
}

TEST(PairedDifference, NoiseBelowNothingDoesNotNarrowTheInterval) {
  const ConfidenceInterval below = mean_square_interval({-3, 1, -2}, 2);
  EXPECT_EQ(below.low, 0);
  EXPECT_EQ(below.high, 2);
  const ConfidenceInterval skewed = mean_square_interval({3, 1, 2}, 2), even = mean_square_interval({3, 1, 0}, 2);
  EXPECT_EQ(even.high, 5);
  EXPECT_GT(skewed.high, 5);
}

TEST(PairedDifference, OfNothingIsNothing) {
  EXPECT_EQ(mean_square({}).mean, 0);
  EXPECT_EQ(mean_product({}, {}), 0);
}

}  // namespace
}  // namespace frond
