#include "scene/distribution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace frond {
namespace {

/// Over an even grid of u each cell is hit as often as its probability says, to within one step at either end.
TEST(Distribution, InvertsItsCumulativeSum) {
  const std::vector<float> weights{0, 1, 0, 0, 7, 1e-3f, 2, 0};
  const Distribution1D d(weights);
  constexpr int kSteps = 100000;
  std::vector<int> hits(weights.size());
  for (int i = 0; i < kSteps; ++i) {
    const float u = (float(i) + 0.5f) / kSteps;
    const auto [cell, fraction, pdf] = d.sample(u);
    ++hits[cell];
    EXPECT_EQ(pdf, d.probability(cell));
    EXPECT_GE(fraction, 0);
    EXPECT_LT(fraction, 1);
  }
  for (size_t c = 0; c < weights.size(); ++c)
    EXPECT_NEAR(hits[c], kSteps * double(weights[c]) / d.sum(), weights[c] > 0 ? 1 : 0) << "cell " << c;
}

TEST(Distribution, EndsOfTheUnitInterval) {
  const Distribution1D d({0, 3, 1, 0});
  EXPECT_EQ(d.sample(0).cell, 1u);
  EXPECT_EQ(d.sample(0x1.fffffep-1f).cell, 2u);
}

TEST(Distribution, AllZeroIsUniform) {
  const Distribution1D d(std::vector<float>(4, 0));
  for (size_t c = 0; c < 4; ++c) EXPECT_EQ(d.sample((float(c) + 0.5f) / 4).cell, c);
}

TEST(Distribution, OfTheSquareAgreesWithItsDensity) {
  const Distribution2D d({1, 2, 0, 5, 0, 4}, 3);
  double integral = 0;
  constexpr int kSteps = 300;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 u{(float(i) + 0.5f) / kSteps, (float(j) + 0.5f) / kSteps};
      integral += double(d.pdf(u)) / (kSteps * kSteps);
      const auto s = d.sample(u);
      EXPECT_NEAR(s.pdf, d.pdf(s.uv), 1e-5f * s.pdf);
      EXPECT_GT(s.pdf, 0);
    }
  EXPECT_NEAR(integral, 1, 1e-6);
}

}  // namespace
}  // namespace frond
