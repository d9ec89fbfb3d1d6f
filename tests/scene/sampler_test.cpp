#include "core/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "scene/registry.h"
#include "tests/support/bind.h"

namespace frond {
namespace {

std::unique_ptr<Sampler> make(std::string_view name, uint64_t seed) {
  const Registry registry = make_registry({}, {});
  return testing::make_plugin(registry.samplers.get(name, {}), {}, seed);
}

/// Of 2^8 successive samples from a multiple of 2^8, each elementary interval holds exactly one point.
void expect_stratified(const Sampler& sampler, uint64_t first, uint32_t dimension) {
  constexpr int kLog = 8, kCount = 1 << kLog;
  for (int log_x = 0; log_x <= kLog; ++log_x) {
    std::set<std::pair<int, int>> cells;
    std::array<Vec2, kCount> numbers;
    sampler.get2d({3, 4, first, kCount}, dimension, numbers.data());
    for (const Vec2 u : numbers) cells.emplace(int(u.x * float(1 << log_x)), int(u.y * float(1 << (kLog - log_x))));
    EXPECT_EQ(cells.size(), size_t(kCount)) << "dimension " << dimension << ", 2^" << log_x << " columns";
  }
}

TEST(PaddedSobol, EveryElementaryIntervalHoldsOnePoint) {
  const auto sampler = make("paddedsobol", 1);
  for (const uint32_t dimension : {0, 1, 7}) expect_stratified(*sampler, 0, dimension);
}

TEST(PaddedSobol, StratifiedBeyond32Bits) {
  const auto sampler = make("paddedsobol", 1);
  expect_stratified(*sampler, 1ull << 32, 0);
  expect_stratified(*sampler, (5ull << 32) + (3ull << 8), 2);
}

TEST(PaddedSobol, OneDimensionIsStratified) {
  const auto sampler = make("paddedsobol", 9);
  std::set<int> cells;
  std::array<float, 1024> numbers;
  sampler->get1d({0, 0, 0, 1024}, 0, numbers.data());
  for (const float u : numbers) cells.insert(int(u * 1024));
  EXPECT_EQ(cells.size(), 1024u);
}

/// Pearson correlation of the first numbers of two streams; |r| sqrt(n) is standard normal where they are independent,
/// so 5 means a false alarm in 1.7 million.
double correlation_score(const Sampler& a, std::pair<int, int> pixel_a, uint32_t dimension_a, const Sampler& b,
                         std::pair<int, int> pixel_b, uint32_t dimension_b) {
  constexpr int kCount = 4096;
  std::array<float, kCount> numbers_a, numbers_b;
  a.get1d({pixel_a.first, pixel_a.second, 0, kCount}, dimension_a, numbers_a.data());
  b.get1d({pixel_b.first, pixel_b.second, 0, kCount}, dimension_b, numbers_b.data());
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (size_t i = 0; i < kCount; ++i) {
    const double x = double(numbers_a[i]), y = double(numbers_b[i]);
    sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
  }
  const double n = kCount, covariance = sab - sa * sb / n;
  return std::abs(covariance / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n))) * std::sqrt(n);
}

TEST(Samplers, PixelsSeedsAndDimensionsAreIndependent) {
  for (const std::string_view name : {"paddedsobol", "independent"}) {
    const auto a = make(name, 1), same = make(name, 1), other_seed = make(name, 2);
    EXPECT_LT(correlation_score(*a, {0, 0}, 0, *same, {1, 0}, 0), 5) << name;
    EXPECT_LT(correlation_score(*a, {0, 0}, 0, *same, {0, 1}, 0), 5) << name;
    EXPECT_LT(correlation_score(*a, {0, 0}, 0, *other_seed, {0, 0}, 0), 5) << name;
    EXPECT_LT(correlation_score(*a, {0, 0}, 0, *same, {0, 0}, 1), 5) << name;
    EXPECT_GT(correlation_score(*a, {0, 0}, 0, *same, {0, 0}, 0), 60) << name;  // the score sees what is the same
  }
}

TEST(Samplers, ASampleHasItsNumbersWhateverElseIsAskedFor) {
  for (const std::string_view name : {"paddedsobol", "independent"}) {
    const auto a = make(name, 7), b = make(name, 7);
    for (const uint64_t first : {uint64_t{0}, uint64_t{70}, (uint64_t{1} << 32) - 20}) {
      constexpr uint32_t kCount = 37;
      std::array<Vec2, kCount> pairs;
      std::array<float, kCount> numbers;
      a->get2d({5, 6, first, kCount}, 3, pairs.data());
      a->get1d({5, 6, first, kCount}, 4, numbers.data());
      for (uint32_t i = 0; i < kCount; ++i) {
        SampleNumbers one(*b, 5, 6, first + i, 3);
        EXPECT_EQ(one.get2d(), pairs[i]) << name << " " << first + i;
        EXPECT_EQ(one.get1d(), numbers[i]) << name << " " << first + i;
      }
    }
  }
}

TEST(Samplers, NumbersLieBelowOne) {
  for (const std::string_view name : {"paddedsobol", "independent"}) {
    std::vector<Vec2> numbers(100000);
    make(name, 3)->get2d({0, 0, 0, uint32_t(numbers.size())}, 0, numbers.data());
    for (const Vec2 u : numbers) ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1) << name;
  }
}

}  // namespace
}  // namespace frond
