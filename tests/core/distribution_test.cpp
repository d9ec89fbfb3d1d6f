#include "core/math/distribution.h"

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

TEST(WindowedDistribution, AgreesWithItsDensityInAnyWindow) {
  const std::vector<float> weights{1, 2, 0, 5, 0, 4};
  const WindowedDistribution d(weights, 3);
  for (const WindowedDistribution::Window& w : {WindowedDistribution::Window{{0, 0}, {1, 1}},
                                                {{0.1f, 0.2f}, {0.9f, 0.7f}},
                                                {{0.4f, 0.1f}, {0.45f, 0.95f}},
                                                {{0.05f, 0.55f}, {0.3f, 0.6f}}}) {
    constexpr int kSteps = 200;
    const float dx = (w.max.x - w.min.x) / kSteps, dy = (w.max.y - w.min.y) / kSteps;
    double integral = 0, mean = 0, sampled = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const Vec2 u{(float(i % kSteps) + 0.5f) / kSteps, (float(i / kSteps) + 0.5f) / kSteps};
      const Vec2 uv{w.min.x + (float(i % kSteps) + 0.5f) * dx, w.min.y + (float(i / kSteps) + 0.5f) * dy};
      integral += double(d.pdf(uv, w) * dx * dy);
      mean += double(d.pdf(uv, w) * dx * dy * (uv.x + 2 * uv.y));
      const auto s = d.sample(u, w);
      ASSERT_TRUE(s);
      EXPECT_TRUE(s->uv.x >= w.min.x - 1e-6f && s->uv.x <= w.max.x + 1e-6f);
      EXPECT_TRUE(s->uv.y >= w.min.y - 1e-6f && s->uv.y <= w.max.y + 1e-6f);
      EXPECT_GT(s->pdf, 0);
      sampled += double(s->uv.x + 2 * s->uv.y) / (kSteps * kSteps);
    }
    EXPECT_NEAR(integral, 1, 0.01);
    EXPECT_NEAR(sampled / mean, 1, 0.01);
  }
  EXPECT_FALSE(d.sample({0.5f, 0.5f}, {{0.7f, 0.1f}, {0.9f, 0.4f}})) << "black there";
  EXPECT_FALSE(d.sample({0.5f, 0.5f}, {{0.2f, 0.2f}, {0.2f, 0.4f}})) << "empty";
  EXPECT_EQ(d.pdf({0.1f, 0.1f}, {{0.2f, 0.2f}, {0.5f, 0.4f}}), 0);
}

}  // namespace
}  // namespace frond
