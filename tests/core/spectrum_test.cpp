#include "core/spectrum.h"

#include <gtest/gtest.h>

namespace frond {
namespace {

SampledWavelengths wavelengths(int count) {
  SampledWavelengths lambda;
  lambda.count = count;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    lambda.nm[i] = 500 + 10 * static_cast<float>(i);
    lambda.pdf[i] = 1;
    lambda.active[i] = true;
  }
  return lambda;
}

struct Ramp final : Spectrum {
  float at(float lambda_nm) const override { return lambda_nm / 1000; }
  Interval range_nm() const override { return {360, 830}; }
  float max_value() const override { return 0.83f; }
};

TEST(SampledSpectrum, ArithmeticGoesLaneByLane) {
  SampledSpectrum a(2), b;
  for (int i = 0; i < kLanes; ++i) b[i] = static_cast<float>(i);
  const SampledSpectrum c = a * b + b * 3;
  for (int i = 0; i < kLanes; ++i) EXPECT_EQ(c[i], 5 * static_cast<float>(i));
  EXPECT_EQ(c.max(), 15);
}

TEST(SampledSpectrum, IsBlackOnlyWhereEveryLaneIsZero) {
  SampledSpectrum s;
  EXPECT_TRUE(s.is_black());
  s[3] = 1e-30f;
  EXPECT_FALSE(s.is_black());
}

TEST(Spectrum, SampleLeavesUnusedLanesAtZero) {
  const SampledSpectrum s = Ramp().sample(wavelengths(3));
  EXPECT_FLOAT_EQ(s[0], 0.5f);
  EXPECT_FLOAT_EQ(s[2], 0.52f);
  EXPECT_EQ(s[3], 0);
}

TEST(Mean, CountsTheLanesInUseAlone) {
  SampledSpectrum s;
  s[0] = 1, s[1] = 2;
  EXPECT_FLOAT_EQ(mean(s, wavelengths(2)), 1.5f);
  EXPECT_FLOAT_EQ(mean(s, wavelengths(4)), 0.75f);
}

TEST(SampledWavelengths, BlackLanesRetireForGood) {
  SampledWavelengths lambda = wavelengths(3);
  SampledSpectrum throughput(1);
  throughput[1] = 0;
  lambda.retire_black_lanes(throughput);
  EXPECT_TRUE(lambda.is_active(0));
  EXPECT_FALSE(lambda.is_active(1));
  EXPECT_TRUE(lambda.is_active(2));
  EXPECT_FALSE(lambda.is_active(3)) << "a lane that is not in use never becomes active";
  lambda.retire_black_lanes(SampledSpectrum(1));
  EXPECT_FALSE(lambda.is_active(1));
}

TEST(Interval, ContainsItsEndsButNotNan) {
  constexpr Interval i{0, 1};
  EXPECT_TRUE(i.contains(0));
  EXPECT_TRUE(i.contains(1));
  EXPECT_FALSE(i.contains(-0.001));
  EXPECT_FALSE(i.contains(std::nan("")));
}

}  // namespace
}  // namespace frond
