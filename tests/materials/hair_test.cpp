// Material "hair" against the formulas of Chiang et al. in double precision, and its densities against samples.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/random.h"
#include "instruments/errors/statistics.h"
#include "tests/materials/support.h"

namespace frond::test {
namespace {

constexpr double kPiDouble = std::numbers::pi;

/// A fibre, with one absorption at all wavelengths.
struct Fiber {
  double v;  ///< texture coordinate across it
  double sigma_a, eta, beta_m, beta_n, alpha;

  Ready ready() const {
    return {"hair",
            {level("sigma_a", sigma_a), real("eta", eta), real("beta_m", beta_m), real("beta_n", beta_n),
             real("alpha", alpha)}};
  }
  double offset() const { return 2 * v - 1; }
};

constexpr Fiber kFibers[] = {{0.5, 0, 1.55, 0.3, 0.3, 2},     {0.1, 0, 1.55, 0.25, 0.3, 0},
                             {0.85, 0.2, 1.4, 0.6, 0.25, -5}, {0.999, 1, 1.55, 0.3, 0.8, 20},
                             {0, 0.1, 1.3, 1, 1, 3},          {0.3, 5, 2, 0.25, 0.5, 60}};

/// The sums of Chiang et al. 2016, term by term, in double precision.
class Formulas {
 public:
  Formulas(const Fiber& fiber, const Vec3& wo) : fiber_(fiber), theta_(std::asin(double(wo.x))) {
    const double h = fiber.offset(), cosine_t = std::cos(std::asin(std::sin(theta_) / fiber.eta));
    gamma_ = std::asin(h);
    gamma_t_ = std::asin(h * std::cos(theta_) / (fiber.eta * cosine_t));
    phi_ = std::atan2(double(wo.z), double(wo.y));
    const double c = std::cos(theta_) * std::cos(gamma_), t = std::sqrt(1 - (1 - c * c) / (fiber.eta * fiber.eta));
    const double along = (fiber.eta * c - t) / (fiber.eta * c + t), across = (c - fiber.eta * t) / (c + fiber.eta * t);
    reflected_ = (along * along + across * across) / 2;
    passed_ = std::exp(-2 * fiber.sigma_a * std::cos(gamma_t_) / cosine_t);
  }

  /// Share of the light that is scattered.
  double albedo() const { return reflected_ + std::pow(1 - reflected_, 2) * passed_ / (1 - reflected_ * passed_); }

  double f_cos(const Vec3& wi) const {
    const double b = fiber_.beta_m, v = std::pow(0.726 * b + 0.812 * b * b + 3.7 * std::pow(b, 20), 2);
    const double variances[] = {v, v / 4, 4 * v}, tilts[] = {-2, 1, 4};
    double share = std::pow(1 - reflected_, 2) * passed_, sum = 0;
    for (int p = 0; p < 3; ++p) {
      if (p > 1) share *= passed_ * reflected_;
      const double turned = theta_ + tilts[p] * fiber_.alpha * kPiDouble / 180;
      sum += (p == 0 ? reflected_ : share) * along(wi, turned, variances[p]) * around(wi, p);
    }
    const double rest = share * passed_ * reflected_ / (1 - passed_ * reflected_);
    return sum + rest * along(wi, theta_, 4 * v) / (2 * kPiDouble);
  }

 private:
  static double along(const Vec3& wi, double theta_o, double v) {
    const double theta_i = std::asin(double(wi.x));
    const double a = std::cos(theta_i) * std::abs(std::cos(theta_o)) / v, b = std::sin(theta_i) * std::sin(theta_o) / v;
    return std::exp(-b) * std::cyl_bessel_i(0., a) / (2 * v * std::sinh(1 / v));
  }
  double around(const Vec3& wi, int p) const {
    const double n = fiber_.beta_n;
    const double s = std::sqrt(kPiDouble / 8) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22));
    const double lobe = 2 * p * gamma_t_ - 2 * gamma_ + p * kPiDouble;
    const double x = std::remainder(std::atan2(double(wi.z), double(wi.y)) - phi_ - lobe, 2 * kPiDouble);
    return std::pow(std::cosh(x / (2 * s)), -2) / (4 * s) / std::tanh(kPiDouble / (2 * s));
  }

  Fiber fiber_;
  double theta_, gamma_, gamma_t_, phi_, reflected_, passed_;
};

/// Unit vector at the angle `theta` against the plane normal to the fibre.
Vec3 direction(double theta, double phi) {
  return {float(std::sin(theta)), float(std::cos(theta) * std::cos(phi)), float(std::cos(theta) * std::sin(phi))};
}

constexpr double kElevations[] = {0.1, -0.8, 1.3};

TEST(Hair, FollowsItsFormulas) {
  RandomStream numbers(1), rng(2);
  for (const Fiber& fiber : kFibers) {
    Ready ready = fiber.ready();
    const Bsdf& bsdf = ready.bsdf({0, float(fiber.v)});
    for (int i = 0; i < 300; ++i) {
      const auto draw = [&] {
        return direction(std::asin(2 * double(numbers.uniform()) - 1), 6.28 * double(numbers.uniform()));
      };
      const Vec3 wo = draw(), wi = draw();
      const double expected = Formulas(fiber, wo).f_cos(wi);
      EXPECT_NEAR(double(bsdf.f(wo, wi, rng)[0] * std::abs(wi.z)), expected, 3e-4 * expected + 1e-9)
          << "v = " << fiber.v << ", wo.x = " << wo.x << ", wi.x = " << wi.x;
    }
  }
}

// White furnace: without absorption all light is scattered; with absorption the share of the closed form. The density
// integrates to 1. By quadrature, without random numbers.
TEST(Hair, ScattersTheShareThatItDoesNotAbsorb) {
  constexpr int kSteps = 150;
  RandomStream rng(1);
  for (const Fiber& fiber : kFibers) {
    Ready ready = fiber.ready();
    const Bsdf& bsdf = ready.bsdf({0, float(fiber.v)});
    for (const double theta_o : kElevations) {
      const Vec3 wo = direction(theta_o, 0.7);
      double scattered = 0, density = 0;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const double theta = kPiDouble * ((i + 0.5) / kSteps - 0.5), phi = 2 * kPiDouble * (j + 0.5) / kSteps;
          const Vec3 wi = direction(theta, phi);
          const double area = 2 * std::pow(kPiDouble / kSteps, 2) * std::cos(theta);
          scattered += double(bsdf.f(wo, wi, rng)[0] * std::abs(wi.z)) * area;
          density += double(bsdf.pdf(wo, wi)) * area;
        }
      const double albedo = Formulas(fiber, wo).albedo();
      EXPECT_NEAR(scattered, albedo, 3e-4) << "v = " << fiber.v << ", theta = " << theta_o;
      EXPECT_NEAR(density, 1, 3e-4) << "v = " << fiber.v << ", theta = " << theta_o;
      if (fiber.sigma_a == 0)
        EXPECT_NEAR(albedo, 1, 1e-12);
      else
        EXPECT_LT(scattered, 1 + 2e-5);
    }
  }
}

// Directions of `sample` against `pdf`: chi-square over 64 bins. 18 tests with p < 1e-8: a false alarm in 5 million
// seeds. Every sample's f and pdf are those of `f` and `pdf`.
TEST(Hair, SamplesItsDensity) {
  constexpr int kRows = 8, kColumns = 8, kFine = 12, kSamples = 20000;
  RandomStream rng(7);
  for (const Fiber& fiber : kFibers) {
    Ready ready = fiber.ready();
    const Bsdf& bsdf = ready.bsdf({0, float(fiber.v)});
    for (const double theta_o : kElevations) {
      const Vec3 wo = direction(theta_o, -2);
      std::vector<double> observed(kRows * kColumns), expected(kRows * kColumns);
      for (int i = 0; i < kRows * kFine; ++i)
        for (int j = 0; j < kColumns * kFine; ++j) {
          const double theta = kPiDouble * ((i + 0.5) / (kRows * kFine) - 0.5);
          const double phi = 2 * kPiDouble * (j + 0.5) / (kColumns * kFine) - kPiDouble;
          const double area = 2 * kPiDouble * kPiDouble / (kRows * kColumns * kFine * kFine) * std::cos(theta);
          expected[size_t(i / kFine * kColumns + j / kFine)] +=
              kSamples * area * double(bsdf.pdf(wo, direction(theta, phi)));
        }
      for (int n = 0; n < kSamples; ++n) {
        const auto s = bsdf.sample(wo, rng.uniform(), {rng.uniform(), rng.uniform()}, rng);
        ASSERT_TRUE(s);
        if (n < 500) {
          EXPECT_FLOAT_EQ(s->pdf, bsdf.pdf(wo, s->wi));
          EXPECT_EQ(s->f, bsdf.f(wo, s->wi, rng));
        }
        const double theta = std::asin(std::clamp(double(s->wi.x), -1., 1.)), phi = std::atan2(s->wi.z, s->wi.y);
        const int row = std::clamp(int((theta / kPiDouble + 0.5) * kRows), 0, kRows - 1);
        const int column = std::clamp(int((phi / (2 * kPiDouble) + 0.5) * kColumns), 0, kColumns - 1);
        ++observed[size_t(row * kColumns + column)];
      }
      EXPECT_GT(chi_square_p(observed, expected), 1e-8) << "v = " << fiber.v << ", theta = " << theta_o;
    }
  }
}

TEST(Hair, TakesVForTheOffsetAndDoesNotDependOnTheNormal) {
  const Fiber fiber{0.2, 0.3, 1.55, 0.3, 0.3, 2};
  Ready ready = fiber.ready();
  RandomStream rng(1);
  const Bsdf& bsdf = ready.bsdf({0.4f, 0.2f});
  const auto f_cos = [&](double turn) {
    const Vec3 wi = direction(-0.2, 2 + turn);
    return double(bsdf.f(direction(0.3, 0.5 + turn), wi, rng)[0] * std::abs(wi.z));
  };
  for (const double turn : {0.5, 1.0, 4.0}) EXPECT_NEAR(f_cos(turn), f_cos(0), 1e-5 * f_cos(0)) << turn;
  // Beyond 0 and 1, which other shapes can have, it is the edge.
  const Vec3 wo = direction(0.3, 0.5), wi = direction(-0.2, 2);
  EXPECT_EQ(fiber.ready().bsdf({0, 7}).f(wo, wi, rng), fiber.ready().bsdf({0, 1}).f(wo, wi, rng));
}

/// Share of the light that is scattered at the middle of a fibre, straight on, by samples without noise of weights.
SampledSpectrum scattered(const std::vector<ParsedParam>& params) {
  Ready ready("hair", params);
  RandomStream rng(1);
  SampledSpectrum sum;
  constexpr int kSamples = 64;
  for (int i = 0; i < kSamples; ++i)
    if (const auto s = ready.bsdf({0, 0.5f}).sample({0, 0, 1}, (float(i) + 0.5f) / kSamples, {0.5f, 0.3f}, rng))
      sum += s->f * (std::abs(s->wi.z) / s->pdf / kSamples);
  return sum;
}

TEST(Hair, TakesTheFirstOfItsAbsorptions) {
  EXPECT_EQ(scattered({}), scattered({real("eumelanin", 1.3)}));
  const SampledSpectrum brown = scattered({real("eumelanin", 2)}),
                        both = scattered({real("eumelanin", 2), real("pheomelanin", 2)});
  EXPECT_LT(both[0], brown[0]);
  EXPECT_GT(brown[0], brown[2]) << "red of blue";
  const SampledSpectrum dark = scattered({level("reflectance", 0)}), white = scattered({level("reflectance", 1)});
  EXPECT_LT(dark[0], 0.1f);
  EXPECT_NEAR(white[0], 1, 1e-4);
  EXPECT_EQ(scattered({level("color", 0.4)}), scattered({level("reflectance", 0.4)}));
  EXPECT_EQ(scattered({level("sigma_a", 0.4), level("reflectance", 0.9), real("eumelanin", 3)}),
            scattered({level("sigma_a", 0.4)}));
  EXPECT_EQ(scattered({level("reflectance", 0.4), level("color", 0.9), real("pheomelanin", 3)}),
            scattered({level("reflectance", 0.4)}));
  EXPECT_EQ(scattered({real("beta_m", 0)}), scattered({real("beta_m", 0.01)}));
}

}  // namespace
}  // namespace frond::test
