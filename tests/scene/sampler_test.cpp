#include "core/sampler.h"

#include <gtest/gtest.h>

#include <set>

#include "scene/registry.h"
#include "tests/support/bind.h"

namespace frond {
namespace {

std::unique_ptr<Sampler> make(std::string_view name, uint64_t seed) {
  const Registry registry = make_registry({}, {});
  return testing::make_plugin(registry.samplers.get(name, {}), {}, seed);
}

/// Of 2^8 successive samples from a multiple of 2^8, each elementary interval holds exactly one point.
void expect_stratified(Sampler& sampler, uint64_t first, int request) {
  constexpr int kLog = 8, kCount = 1 << kLog;
  for (int log_x = 0; log_x <= kLog; ++log_x) {
    std::set<std::pair<int, int>> cells;
    for (int i = 0; i < kCount; ++i) {
      sampler.start(3, 4, first + uint64_t(i));
      for (int k = 0; k < request; ++k) (void)sampler.get2d();
      const Vec2 u = sampler.get2d();
      cells.emplace(int(u.x * float(1 << log_x)), int(u.y * float(1 << (kLog - log_x))));
    }
    EXPECT_EQ(cells.size(), size_t(kCount)) << "request " << request << ", 2^" << log_x << " columns";
  }
}

TEST(PaddedSobol, EveryElementaryIntervalHoldsOnePoint) {
  const auto sampler = make("paddedsobol", 1);
  for (const int request : {0, 1, 7}) expect_stratified(*sampler, 0, request);
}

TEST(PaddedSobol, StratifiedBeyond32Bits) {
  const auto sampler = make("paddedsobol", 1);
  expect_stratified(*sampler, 1ull << 32, 0);
  expect_stratified(*sampler, (5ull << 32) + (3ull << 8), 2);
}

TEST(PaddedSobol, OneDimensionIsStratified) {
  const auto sampler = make("paddedsobol", 9);
  std::set<int> cells;
  for (uint64_t i = 0; i < 1024; ++i) {
    sampler->start(0, 0, i);
    cells.insert(int(sampler->get1d() * 1024));
  }
  EXPECT_EQ(cells.size(), 1024u);
}

/// Pearson correlation of the first numbers of two streams; |r| sqrt(n) is standard normal where they are independent,
/// so 5 means a false alarm in 1.7 million.
double correlation_score(Sampler& a, std::pair<int, int> pixel_a, int skip_a, Sampler& b, std::pair<int, int> pixel_b,
                         int skip_b) {
  constexpr int kCount = 4096;
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (uint64_t i = 0; i < kCount; ++i) {
    a.start(pixel_a.first, pixel_a.second, i);
    for (int k = 0; k < skip_a; ++k) (void)a.get1d();
    const double x = double(a.get1d());
    b.start(pixel_b.first, pixel_b.second, i);
    for (int k = 0; k < skip_b; ++k) (void)b.get1d();
    const double y = double(b.get1d());
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

TEST(Samplers, TheSameSampleGivesTheSameNumbers) {
  for (const std::string_view name : {"paddedsobol", "independent"}) {
    const auto a = make(name, 7);
    const auto b = a->clone();
    a->start(5, 6, 70);
    b->start(1, 2, 3);
    (void)b->get2d();
    b->start(5, 6, 70);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(a->get2d(), b->get2d()) << name;
  }
}

TEST(Samplers, NumbersLieBelowOne) {
  for (const std::string_view name : {"paddedsobol", "independent"}) {
    const auto sampler = make(name, 3);
    for (uint64_t i = 0; i < 100000; ++i) {
      sampler->start(0, 0, i);
      const Vec2 u = sampler->get2d();
      ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1) << name;
    }
  }
}

}  // namespace
}  // namespace frond
