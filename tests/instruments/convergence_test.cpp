#include "instruments/errors/convergence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace frond {
namespace {

using ::testing::ElementsAre;

/// Noise of variance 1 / samples, a hundredth of a second a sample.
Convergence ideal(double bias_squared, double standard_error = 0) {
  std::vector<ConvergencePoint> points;
  for (const double n : {1.0, 2.0, 4.0, 8.0}) points.push_back({n, n / 100, {1 / n, 0}});
  return Convergence(points, {bias_squared, standard_error});
}

TEST(Convergence, NoiseFollowsAPowerLawBetweenPoints) {
  const auto effort = ideal(0).until_noise(1 / 3.0);
  ASSERT_TRUE(effort);
  EXPECT_NEAR(effort->samples, 3, 1e-9);
  EXPECT_NEAR(effort->seconds, 0.03, 1e-9);
  EXPECT_TRUE(effort->measured);
}

TEST(Convergence, GoesOnAsOneOverSamples) {
  const auto effort = ideal(0).until_noise(0.01);
  ASSERT_TRUE(effort);
  EXPECT_NEAR(effort->samples, 100, 1e-9);
  EXPECT_NEAR(effort->seconds, 1, 1e-9);
  EXPECT_FALSE(effort->measured);
}

TEST(Convergence, NeedsNoLessThanTheFirstPoint) { EXPECT_EQ(ideal(0).until_noise(100)->samples, 1); }

TEST(Convergence, BiasLeavesLessForNoise) {
  const auto effort = ideal(0.09).until_rms(0.5);  // 0.25 = 0.09 + 0.16
  ASSERT_TRUE(effort);
  EXPECT_NEAR(effort->samples, 1 / 0.16, 1e-9);
  EXPECT_FALSE(ideal(0.09).until_rms(0.3));
  EXPECT_FALSE(ideal(0.09, 0.08).until_rms(0.5, 2));
  EXPECT_TRUE(ideal(-0.01, 0.001).until_rms(0.5, 2));
}

TEST(Convergence, PlateauIsWhereNoiseMeetsBias) {
  EXPECT_NEAR(ideal(0.25).until_plateau()->samples, 4, 1e-9);
  EXPECT_FALSE(ideal(0.25, 0.2).until_plateau());
  EXPECT_FALSE(ideal(-0.1).until_plateau());
}

TEST(ParetoFrontier, HoldsWhatNothingBeats) {
  const std::vector<CostAndError> points{{3, 1}, {1, 5}, {2, 6}, {1, 7}, {4, 1}, {2, 2}};
  EXPECT_THAT(pareto_frontier(points), ElementsAre(1, 5, 0));
  EXPECT_THAT(pareto_frontier({}), ElementsAre());
}

}  // namespace
}  // namespace frond
