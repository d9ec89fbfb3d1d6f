#include "core/math/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace frond {
namespace {

template <int kFraction>
ExactSum<kFraction> sum_of(const std::vector<double>& terms) {
  ExactSum<kFraction> sum;
  for (const double t : terms) sum.add(t);
  return sum;
}

/// Terms of both signs over many orders of magnitude, up to `largest`.
std::vector<double> terms(size_t count, double largest, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-40, 0);
  std::vector<double> result(count);
  for (double& t : result) t = std::ldexp(mantissa(random) * largest, exponent(random));
  return result;
}

template <class Sum>
class ExactSums : public ::testing::Test {};

template <int kFraction_>
struct Fraction {
  static constexpr int kFraction = kFraction_;
};
using Fractions = ::testing::Types<Fraction<40>, Fraction<60>>;
TYPED_TEST_SUITE(ExactSums, Fractions);

TYPED_TEST(ExactSums, AnyOrderIsTheSame) {
  constexpr int kFraction = TypeParam::kFraction;
  std::vector<double> t = terms(2000, ExactSum<kFraction>::kLargestTerm, 1);
  const auto sum = sum_of<kFraction>(t);
  std::mt19937_64 random(2);
  for (int i = 0; i < 20; ++i) {
    std::ranges::shuffle(t, random);
    EXPECT_EQ(sum_of<kFraction>(t), sum);
  }
  std::ranges::sort(t);
  EXPECT_EQ(sum_of<kFraction>(t), sum);
}

TYPED_TEST(ExactSums, AnySplitIsTheSame) {
  constexpr int kFraction = TypeParam::kFraction;
  const std::vector<double> t = terms(2000, ExactSum<kFraction>::kLargestTerm, 3);
  const auto sum = sum_of<kFraction>(t);
  std::mt19937_64 random(4);
  for (int i = 0; i < 20; ++i) {
    std::vector<ExactSum<kFraction>> parts(1 + random() % 17);
    for (const double x : t) parts[random() % parts.size()].add(x);
    std::ranges::shuffle(parts, random);
    ExactSum<kFraction> together;
    for (const auto& part : parts) together += part;
    EXPECT_EQ(together, sum);
    EXPECT_EQ(together.value(), sum.value());
  }
}

TYPED_TEST(ExactSums, TheValueIsTheSum) {
  constexpr int kFraction = TypeParam::kFraction;
  for (const double largest : {1e-6, 1.0, 1e6}) {
    const std::vector<double> t = terms(1000, largest, 5);
    long double expected = 0, magnitude = 0;
    for (const double x : t) expected += x, magnitude += std::abs(x);
    const long double rounding = magnitude * 0x1p-52L + static_cast<long double>(t.size()) * std::ldexp(2, -kFraction);
    EXPECT_NEAR(double(sum_of<kFraction>(t).value() - expected), 0, double(rounding)) << largest;
  }
}

TYPED_TEST(ExactSums, TermsAndTheirNegativesAreNothing) {
  constexpr int kFraction = TypeParam::kFraction;
  std::vector<double> t = terms(1000, ExactSum<kFraction>::kLargestTerm, 6);
  const std::vector<double> positive = t;
  for (const double x : positive) t.push_back(-x);
  std::ranges::shuffle(t, std::mt19937_64(7));
  EXPECT_EQ(sum_of<kFraction>(t), ExactSum<kFraction>());
  EXPECT_EQ(sum_of<kFraction>(t).value(), 0);
}

TYPED_TEST(ExactSums, ATermIsRoundedTowardZeroByLessThanItsUnit) {
  constexpr int kFraction = TypeParam::kFraction;
  const double unit = std::ldexp(2, -kFraction);
  for (const double x : terms(5000, 100, 8)) {
    const double kept = sum_of<kFraction>({x}).value();
    EXPECT_LE(std::abs(kept), std::abs(x));
    EXPECT_LT(std::abs(x - kept), unit) << x;
    EXPECT_FALSE(std::signbit(kept) != std::signbit(x) && kept != 0) << x;
  }
  EXPECT_EQ(sum_of<kFraction>({unit}).value(), unit);
  EXPECT_EQ(sum_of<kFraction>({-unit}).value(), -unit);
  EXPECT_EQ(sum_of<kFraction>({0.99 * unit}).value(), 0);
  EXPECT_EQ(sum_of<kFraction>({-0.99 * unit}).value(), 0);
  EXPECT_EQ(sum_of<kFraction>({0, -0.0, 1e-300, -1e-300}), ExactSum<kFraction>());
}

TYPED_TEST(ExactSums, ABillionOfTheLargestTermsFit) {
  constexpr int kFraction = TypeParam::kFraction;
  for (const double sign : {1.0, -1.0}) {
    const double largest = sign * ExactSum<kFraction>::kLargestTerm;
    ExactSum<kFraction> sum = sum_of<kFraction>({largest});
    EXPECT_EQ(sum.value(), largest);
    for (int i = 0; i < 30; ++i) sum += ExactSum<kFraction>(sum);
    EXPECT_EQ(sum.value(), std::ldexp(largest, 30));
  }
}

}  // namespace
}  // namespace frond
