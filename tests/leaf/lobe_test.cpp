#include "leaf/tissue/lobe.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/beta.hpp>
#include <numbers>

#include "core/math/vec.h"
#include "tests/leaf/statistics.h"

namespace frond::leaf {
namespace {

constexpr double kExponents[] = {0, 0.2, 0.5, 1, 2, 3, 5, 7.5, 10, 13, 30, 100, 1000};

TEST(Lobe, KeepsAllAtTheNormalAndHalfAtGrazing) {
  for (const double e : kExponents) {
    EXPECT_NEAR(TabulatedLobe(e).kept_share(1), 1, 1e-12) << e;
    EXPECT_NEAR(TabulatedLobe(e).kept_share(0), 0.5, 1e-12) << e;
    EXPECT_NEAR(Lobe(e).kept_share(1), 1, 1e-12) << e;
    EXPECT_NEAR(Lobe(e).kept_share(0), 0.5, 1e-12) << e;
  }
}

TEST(Lobe, KeepsTheClosedFormsShare) {
  const TabulatedLobe even(0), cosine(1), cubic(3);
  for (double theta = 0; theta <= 1.57; theta += 0.01) {
    const double c = std::cos(theta);
    EXPECT_NEAR(even.kept_share(c), 1 - theta / std::numbers::pi, 1e-6);
    EXPECT_NEAR(cosine.kept_share(c), (1 + c) / 2, 1e-12);
    EXPECT_NEAR(cubic.kept_share(c), 0.5 + c * (3 - c * c) / 4, 1e-8);
  }
}

/// Integral over the sphere's half on the axis's side, by a fine midpoint rule around the axis.
double kept_by_quadrature(double exponent, double theta) {
  const int rings = 4000;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    // Rings of equal probability: cos alpha = xi^(1/(e+1)); the part of a ring above the wall is an arc.
    const double cos_alpha = std::pow((i + 0.5) / rings, 1 / (exponent + 1));
    const double above = cos_alpha * std::cos(theta) / (std::sqrt(1 - cos_alpha * cos_alpha) * std::sin(theta));
    sum += above >= 1 ? 1 : 1 - std::acos(above) / std::numbers::pi;
  }
  return sum / rings;
}

TEST(Lobe, KeepsWhatQuadratureFindsForAnyExponent) {
  for (const double e : kExponents)
    for (const double theta : {0.05, 0.4, 0.9, 1.3, 1.5, 1.55, 1.57})
      EXPECT_NEAR(Lobe(e).kept_share(std::cos(theta)), kept_by_quadrature(e, theta), 1e-4) << e << " " << theta;
}

TEST(Lobe, TableIsWhatItTabulates) {
  for (const double e : kExponents)
    for (double c = 0; c <= 1; c += 1e-3)
      EXPECT_NEAR(TabulatedLobe(e).kept_share(c), Lobe(e).kept_share(c), 1e-5) << e << " " << c;
}

TEST(Lobe, DensityIntegratesToOneBeforeTheCut) {
  for (const double e : kExponents) {
    const Lobe lobe(e);
    const int steps = 200000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += lobe.density((i + 0.5) / steps);
    EXPECT_NEAR(2 * std::numbers::pi * sum / steps, 1, 1e-4) << e;
  }
}

// The m-th moment of the cosine is (e + 1) / (e + 1 + m).
TEST(Lobe, SamplesTheCosineOfItsDensity) {
  const double limit = test::z_limit(2 * static_cast<int>(std::size(kExponents)));
  for (const double e : kExponents) {
    const Lobe lobe(e);
    RandomStream rng(1);
    test::Estimate first, second;
    for (int i = 0; i < 100000; ++i) {
      const double c = lobe.sample_cos(rng.uniform_open(), rng);
      first.add(c);
      second.add(c * c);
    }
    EXPECT_LT(std::abs(first.mean() - (e + 1) / (e + 2)), limit * first.standard_error()) << e;
    EXPECT_LT(std::abs(second.mean() - (e + 1) / (e + 3)), limit * second.standard_error()) << e;
  }
}

TEST(PowerQuantile, IsTheInverseOfItsIntegral) {
  for (const double e : kExponents)
    for (const double a : {e / 2 + 0.5, e / 2 + 1}) {
      const PowerQuantile quantile(a);
      for (float share = 1e-6f; share < 1; share += 0.00037f) {
        const auto [sine, cosine] = quantile.at(share);
        ASSERT_NEAR(sine * sine + cosine * cosine, 1, 1e-6) << a << " " << share;
        // Near the ends the sine has no digits for it, elsewhere the cosine.
        const double c = static_cast<double>(cosine), s = std::abs(static_cast<double>(sine));
        const double beyond = boost::math::ibeta(a, a, s < 0.7 ? (1 - s) / 2 : c * c / (2 * (1 + s)));
        const auto exact = static_cast<double>(share);
        ASSERT_NEAR(beyond, std::min(exact, 1 - exact), 1e-6 + 1e-7 * std::sqrt(a)) << a << " " << share;
      }
    }
}

TEST(PowerQuantile, EndsLieAtRightAnglesAndTheMiddleAhead) {
  for (const double a : {0.5, 1.0, 3.5, 501.0}) {
    const PowerQuantile quantile(a);
    EXPECT_EQ(quantile.at(0.5f).cosine, 1) << a;
    EXPECT_EQ(quantile.at(0.5f).sine, 0) << a;
    EXPECT_EQ(quantile.at(0).sine, -quantile.at(1).sine) << a;
    EXPECT_GE(quantile.at(0).cosine, 0) << a;
  }
  EXPECT_LT(PowerQuantile(0.5).at(0).cosine, 1e-6f);
}

}  // namespace
}  // namespace frond::leaf
