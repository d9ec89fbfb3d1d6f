#include "core/math/random.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <set>
#include <vector>

#include "core/sampler.h"

namespace frond {
namespace {

/// p-value of "these counts come from equal shares".
double equal_shares_p(const std::vector<int>& counts) {
  double total = 0, statistic = 0;
  for (const int c : counts) total += c;
  const double expected = total / static_cast<double>(counts.size());
  for (const int c : counts) statistic += (c - expected) * (c - expected) / expected;
  return cdf(complement(boost::math::chi_squared(static_cast<double>(counts.size() - 1)), statistic));
}

// Each p-value below may fall under this by chance: one seed in a million.
constexpr double kFalseAlarmRate = 1e-6;

TEST(RandomStream, DrawDependsOnKeyAndNumberAlone) {
  RandomStream a(42), b(42);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.bits(), b.bits());
  EXPECT_NE(RandomStream(42).bits(), RandomStream(43).bits());
}

TEST(RandomStream, NumbersStayInTheirIntervals) {
  RandomStream numbers(1);
  for (int i = 0; i < 100'000; ++i) {
    const float f = numbers.uniform();
    const double d = numbers.uniform_double(), open = numbers.uniform_open();
    ASSERT_TRUE(f >= 0 && f < 1 && d >= 0 && d < 1 && open > 0 && open < 1);
  }
}

TEST(RandomStream, NumbersAreEvenlySpread) {
  std::vector<int> counts(256, 0);
  RandomStream numbers(2);
  for (int i = 0; i < 256'000; ++i) ++counts[static_cast<size_t>(numbers.uniform() * 256)];
  EXPECT_GT(equal_shares_p(counts), kFalseAlarmRate);
}

TEST(RandomStream, SuccessiveNumbersAreIndependent) {
  std::vector<int> counts(32 * 32, 0);
  RandomStream numbers(3);
  for (int i = 0; i < 200'000; ++i) {
    const auto a = static_cast<size_t>(numbers.uniform() * 32), b = static_cast<size_t>(numbers.uniform() * 32);
    ++counts[32 * a + b];
  }
  EXPECT_GT(equal_shares_p(counts), kFalseAlarmRate);
}

TEST(RandomStream, StreamsOfNeighbouringKeysAreIndependent) {
  std::vector<int> counts(32 * 32, 0);
  for (int x = 0; x < 400; ++x)
    for (int y = 0; y < 400; ++y) {
      RandomStream here(sample_key(1, x, y, 0)), beside(sample_key(1, x + 1, y, 0));
      ++counts[32 * static_cast<size_t>(here.uniform() * 32) + static_cast<size_t>(beside.uniform() * 32)];
    }
  EXPECT_GT(equal_shares_p(counts), kFalseAlarmRate);
}

TEST(SampleKey, DiffersBySeedPixelAndSample) {
  std::set<uint64_t> keys;
  for (const uint64_t seed : {1, 2})
    for (int x = -8; x < 8; ++x)
      for (int y = -8; y < 8; ++y)
        for (const uint64_t sample : {uint64_t{0}, uint64_t{1}, uint64_t{1} << 40})
          keys.insert(sample_key(seed, x, y, sample));
  EXPECT_EQ(keys.size(), 2u * 16 * 16 * 3);
}

TEST(HashKey, DependsOnTheOrderOfItsParts) { EXPECT_NE(hash_key(1, 2, 3), hash_key(1, 3, 2)); }

TEST(HashBytes, DependsOnEveryByteAndTheSeed) {
  EXPECT_NE(hash_bytes("leaf"), hash_bytes("leaves"));
  EXPECT_NE(hash_bytes("leaf"), hash_bytes("lear"));
  EXPECT_NE(hash_bytes("leaf", 1), hash_bytes("leaf", 2));
}

}  // namespace
}  // namespace frond
