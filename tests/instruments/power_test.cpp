#include "instruments/errors/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/random.h"

/// Errors of the size that is called detectable are found in the stated share of experiments. 5 standard errors of this
/// share: each expectation fails for one seed in two million, and those here are fixed.
namespace frond {
namespace {

constexpr double kPower = 0.95, kLevel = 1e-3;
constexpr int kExperiments = 2000;
const double kTolerance = 5 * std::sqrt(kPower * (1 - kPower) / kExperiments);

/// Share of the experiments that find an error. `find` returns whether an experiment does, with a separate random
/// stream.
template <class Experiment>
double share_found(const Experiment& find) {
  double found = 0;
  for (uint64_t i = 0; i < kExperiments; ++i) {
    RandomStream numbers(hash_key(7, i));
    found += find(numbers) ? 1 : 0;
  }
  return found / kExperiments;
}

/// Mean of `count` weights of 0 or `weight`, half of them 0 on average.
Estimate half_black(RandomStream& numbers, int count, double weight) {
  Moments moments;
  for (int i = 0; i < count; ++i) moments.add(numbers.uniform() < 0.5f ? 0 : weight);
  return moments.estimate();
}

TEST(Power, OfTheTestOfAMean) {
  constexpr int kSamples = 1000;
  RandomStream numbers(1);
  const double excess = detectable_difference(half_black(numbers, kSamples, 2), kLevel, kPower);
  EXPECT_GT(excess, 0.1);
  // The weights of the larger mean vary less, relative to it: their difference from the bound is the same error.
  EXPECT_NEAR(share_found([&](RandomStream& own) {
                Estimate e = half_black(own, kSamples, 2);
                e.mean += excess;
                return at_most_p(e, 1, 0) < kLevel;
              }),
              kPower, kTolerance);
}

/// Weights of a lobe that one of 50 samples hits: the estimate is skewed.
TEST(Power, OfTheTestOfASkewedMean) {
  const auto rare = [](RandomStream& numbers) {
    Moments moments;
    for (int i = 0; i < 4000; ++i) moments.add(numbers.uniform() < 0.02f ? 50 : 0);
    return moments.estimate();
  };
  // The detectable difference of an estimate varies with the estimate's error: the expected one is used.
  Moments all;
  for (int i = 0; i < 4000; ++i) all.add(i % 50 == 0 ? 50 : 0);
  const double excess = detectable_difference(all.estimate(), kLevel, kPower);
  EXPECT_NEAR(share_found([&](RandomStream& own) {
                Estimate e = rare(own);
                e.mean += excess;
                return at_most_p(e, 1, 0) < kLevel;
              }),
              kPower, kTolerance);
}

TEST(Power, OfChiSquare) {
  constexpr int kClasses = 20, kCount = 5000;
  const double w = detectable_deviation(kClasses - 1, kCount, kLevel, kPower);
  const std::vector<double> expected(kClasses, double(kCount) / kClasses);
  EXPECT_NEAR(share_found([&](RandomStream& own) {
                // Every other class has 1 + w or 1 - w of its share.
                std::vector<double> observed(kClasses, 0);
                for (int i = 0; i < kCount; ++i) {
                  const int pair = int(own.uniform() * kClasses / 2);
                  observed[size_t(2 * pair + (own.uniform_double() < (1 + w) / 2 ? 0 : 1))] += 1;
                }
                return chi_square_p(observed, expected) < kLevel;
              }),
              kPower, kTolerance);
}

/// The number of successes is whole: the power is at least the stated one.
TEST(Power, OfTheBinomialTest) {
  constexpr int kTrials = 2000;
  constexpr double kLow = 0.98;
  const auto successes = [](RandomStream& own, double probability) {
    int64_t count = 0;
    for (int i = 0; i < kTrials; ++i) count += own.uniform_double() < probability ? 1 : 0;
    return count;
  };
  const double less = detectable_shortfall(kTrials, kLow, kLevel, kPower);
  const double of_shortfall = share_found(
      [&](RandomStream& own) { return binomial_p(successes(own, kLow - less), kTrials, kLow, 1) < kLevel; });
  EXPECT_GT(of_shortfall, kPower - kTolerance);
  EXPECT_LT(of_shortfall, kPower + 0.02);
  constexpr double kProbability = 0.6;
  const double high = kProbability - detectable_surplus(kTrials, kProbability, kLevel, kPower);
  const double of_surplus = share_found(
      [&](RandomStream& own) { return binomial_p(successes(own, kProbability), kTrials, 0, high) < kLevel; });
  EXPECT_GT(of_surplus, kPower - kTolerance);
  EXPECT_LT(of_surplus, kPower + 0.02);
  EXPECT_TRUE(std::isinf(detectable_shortfall(5, 0.5, 1e-6, kPower))) << "five trials show nothing at this level";
}

TEST(Power, OfCasesWithoutExceptions) {
  EXPECT_NEAR(detectable_share(20000, kPower), 3.0 / 20000, 0.01 / 20000);  // the rule of three
  EXPECT_NEAR(1 - std::pow(1 - detectable_share(50, kPower), 50), kPower, 1e-12);
}

}  // namespace
}  // namespace frond
