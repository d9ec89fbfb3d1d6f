#include "instruments/errors/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/math/random.h"

namespace frond {
namespace {

TEST(Moments, OfFourNumbers) {
  Moments m;
  for (const double x : {1.0, 2.0, 3.0, 4.0}) m.add(x);
  EXPECT_DOUBLE_EQ(m.mean(), 2.5);
  EXPECT_DOUBLE_EQ(m.variance(), 5.0 / 3);
  EXPECT_DOUBLE_EQ(m.estimate().standard_error(), std::sqrt(5.0 / 12));
  EXPECT_DOUBLE_EQ(m.estimate().third_cumulant, 0);
  EXPECT_DOUBLE_EQ(m.effective_count(), 100.0 / 30);
}

TEST(Moments, ZerosCountLikeAnyNumber) {
  Moments one, other;
  for (const double x : {3.0, 0.0, 0.0, 5.0}) one.add(x);
  other.add(3), other.add(5), other.add_zeros(2);
  EXPECT_EQ(one.count(), other.count());
  EXPECT_DOUBLE_EQ(one.mean(), other.mean());
  EXPECT_DOUBLE_EQ(one.variance(), other.variance());
}

TEST(Moments, OfNothingAndOfOneHaveNoSpread) {
  Moments m;
  EXPECT_EQ(m.mean(), 0);
  EXPECT_EQ(m.estimate().variance, 0);
  m.add(7);
  EXPECT_EQ(m.variance(), 0);
}

// Values of Abramowitz and Stegun 1964, tables 26.1 and 26.7.
TEST(Tails, AgreeWithTables) {
  EXPECT_NEAR(normal_upper_tail(1.96), 0.0249979, 1e-7);
  EXPECT_NEAR(equality_p({1.96, 1}, {0, 0}, 0), 0.0499958, 1e-7);
  const std::array observed{14.0, 6.0}, expected{10.0, 10.0};  // chi-square 3.2, 1 degree of freedom
  EXPECT_NEAR(chi_square_p(observed, expected), 0.07364, 1e-5);
}

TEST(EqualityP, AllowsForTheSlack) {
  EXPECT_EQ(equality_p({1.05, 0}, {1, 0}, 0.1), 1);
  EXPECT_EQ(equality_p({1.2, 0}, {1, 0}, 0.1), 0);
  EXPECT_EQ(equality_p({0.8, 0}, {1, 0}, 0.1), 0);
}

TEST(AtMostP, IsOneSided) {
  EXPECT_EQ(at_most_p({0.2, 1e-4}, 1, 0), 1);
  EXPECT_LT(at_most_p({1.1, 1e-4}, 1, 0), 1e-20);
}

TEST(ConfidenceInterval, EndsWhereTheTestIsUndecided) {
  const Estimate skewed{2, 0.04, 0.004};
  const ConfidenceInterval interval = confidence_interval(skewed, 2.5);
  EXPECT_NEAR(at_most_p(skewed, interval.low, 0), normal_upper_tail(2.5), 1e-12);
  const Estimate mirrored{-2, 0.04, -0.004};
  EXPECT_NEAR(at_most_p(mirrored, -interval.high, 0), normal_upper_tail(2.5), 1e-12);
  EXPECT_GT(interval.high - 2, 2 - interval.low);  // there is more to come above than was seen
  const ConfidenceInterval even = confidence_interval({2, 0.04, 0}, 2.5);
  EXPECT_NEAR(even.low, 1.5, 1e-12);
  EXPECT_NEAR(even.high, 2.5, 1e-12);
}

// 20,000 means of 100 squares of squares of normal numbers: the true mean lies above the upper 95 % end more than 7.5 %
// of the time less than once in 10^40 seeds if it should 7 % of the time. A normal end misses it 10 % of the time.
TEST(ConfidenceInterval, HoldsForMeansOfSkewedNumbers) {
  RandomStream random(5);
  int missed = 0, missed_by_normal = 0;
  constexpr int kRuns = 20000;
  for (int run = 0; run < kRuns; ++run) {
    Moments m;
    for (int i = 0; i < 100; ++i) m.add(-std::log(random.uniform_open()) * -std::log(random.uniform_open()));
    const Estimate e = m.estimate();
    missed += confidence_interval(e, 1.645).high < 1;
    missed_by_normal += e.mean + 1.645 * e.standard_error() < 1;
  }
  EXPECT_LT(missed, 0.075 * kRuns);
  EXPECT_GT(missed_by_normal, 0.085 * kRuns);
}

TEST(PValues, AreZeroForNan) {
  EXPECT_EQ(equality_p({std::nan(""), 1}, {0, 0}, 0), 0);
  EXPECT_EQ(at_most_p({0, std::nan("")}, 1, 0), 0);
  const std::array observed{10.0, 10.0}, expected{10.0, std::nan("")};
  EXPECT_EQ(chi_square_p(observed, expected), 0);
}

TEST(BinomialP, AgreesWithCountingByHand) {
  EXPECT_NEAR(binomial_p(0, 10, 0.5, 0.5), 2.0 / 1024, 1e-12);
  EXPECT_NEAR(binomial_p(9, 10, 0.5, 0.5), 2 * 11.0 / 1024, 1e-12);
  EXPECT_EQ(binomial_p(5, 10, 0.5, 0.5), 1);
}

TEST(BinomialP, TakesTheMostFavourableProbability) {
  EXPECT_EQ(binomial_p(6, 10, 0.5, 0.7), 1);
  EXPECT_DOUBLE_EQ(binomial_p(9, 10, 0.3, 0.5), binomial_p(9, 10, 0.5, 0.5));
  EXPECT_EQ(binomial_p(10, 10, 0.99, 1.01), 1);
  EXPECT_EQ(binomial_p(1, 10, -0.1, 0), 0);
}

TEST(ChiSquareP, PoolsClassesThatExpectLittle) {
  const std::array observed{2.0, 2.0, 2.0, 10.0, 1.0}, expected{2.0, 2.0, 2.0, 10.0, 1.0};
  EXPECT_EQ(chi_square_p(observed, expected), 1);
  const std::array few{3.0, 0.0}, expected_few{2.0, 1.0};
  EXPECT_EQ(chi_square_p(few, expected_few), 1) << "one class tells nothing";
}

TEST(ChiSquareP, CountsWhereNothingIsExpectedAreSeen) {
  const std::array observed{500.0, 500.0, 400.0}, expected{700.0, 700.0, 0.0};
  EXPECT_LT(chi_square_p(observed, expected), 1e-5);
}

TEST(SidakLevel, MakesTheRateThatOfAllTests) {
  EXPECT_DOUBLE_EQ(sidak_level(0.01, 1), 0.01);
  EXPECT_NEAR(1 - std::pow(1 - sidak_level(0.01, 1000), 1000), 0.01, 1e-12);
}

// p-values of a true hypothesis are uniform: of 2000, those below 0.05 are binomial. A new seed fails this once in
// 10^6.
TEST(ChiSquareP, FallsBelowFivePercentAsOftenAsItSays) {
  RandomStream numbers(11);
  int64_t alarms = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> observed(20, 0), expected(20, 50);
    for (int i = 0; i < 1000; ++i) observed[static_cast<size_t>(numbers.uniform() * 20)] += 1;
    if (chi_square_p(observed, expected) < 0.05) ++alarms;
  }
  EXPECT_GT(binomial_p(alarms, 2000, 0.05, 0.05), 1e-6) << alarms;
}

// As above, in the far tail and for skew values: of 20,000 means of rare events, those with p below 0.001.
TEST(EqualityP, HoldsItsRateForSkewValues) {
  RandomStream numbers(12);
  int64_t alarms = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Moments m;
    for (int i = 0; i < 1000; ++i)
      if (numbers.uniform() < 0.1f) m.add(1);
    m.add_zeros(1000 - m.count());
    if (equality_p(m.estimate(), {.mean = 0.1}, 0) < 0.001) ++alarms;
  }
  EXPECT_GT(binomial_p(alarms, 20000, 0, 0.0015), 1e-6) << alarms;
}

}  // namespace
}  // namespace frond
