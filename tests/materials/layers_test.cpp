#include <gtest/gtest.h>

#include "instruments/given_wavelengths.h"
#include "materials/lobes/layered.h"

namespace frond::test {
namespace {

SampledWavelengths one_wavelength() { return GivenWavelengths({550}).sample(0); }

TEST(Fresnel, OfADielectricIsThatOfTextbooks) {
  EXPECT_FLOAT_EQ(fresnel_dielectric(1, 1.5f), 0.04f);
  EXPECT_EQ(fresnel_dielectric(0, 1.5f), 1);
  EXPECT_EQ(fresnel_dielectric(0.7f, 1 / 1.5f), 1);  // beyond the critical angle, whose cosine is 0.745
  EXPECT_NEAR(fresnel_dielectric(0.4f, 1), 0, 1e-12f);
  // At Brewster's angle, tan = eta, one polarisation is let through; the other has ((eta^2 - 1) / (eta^2 + 1))^2.
  const float across = (1.5f * 1.5f - 1) / (1.5f * 1.5f + 1);
  EXPECT_NEAR(fresnel_dielectric(1 / std::hypot(1.f, 1.5f), 1.5f), across * across / 2, 1e-6f);
}

TEST(Fresnel, IsTheSameFromBothSides) {
  for (const float cosine : {0.1f, 0.5f, 0.9f}) {
    const float beyond = std::sqrt(1 - (1 - cosine * cosine) / (1.5f * 1.5f));
    EXPECT_NEAR(fresnel_dielectric(cosine, 1.5f), fresnel_dielectric(beyond, 1 / 1.5f), 1e-6f);
  }
}

TEST(Fresnel, OfAConductorWithoutAbsorptionIsThatOfADielectric) {
  for (const float cosine : {0.f, 0.1f, 0.5f, 1.f})
    for (const float eta : {0.9f, 1.5f, 3.f})
      EXPECT_NEAR(fresnel_conductor(cosine, SampledSpectrum(eta), {})[0], fresnel_dielectric(cosine, eta), 2e-6f)
          << cosine << ' ' << eta;
}

TEST(Fresnel, OfAConductorByItsReflectanceIsThatAtNormalIncidence) {
  for (const float r : {0.f, 0.3f, 0.9f}) {
    const auto indices = ConductorIndices::of_reflectance(SampledSpectrum(r));
    EXPECT_NEAR(fresnel_conductor(1, indices.eta, indices.k)[2], r, 2e-6f);
  }
}

/// Snell's law, and the radiance that it changes by the square of the index.
TEST(Dielectric, RefractsBySnell) {
  const LaneIndices indices(SampledSpectrum(1.5f), one_wavelength());
  const SmoothDielectricBsdf glass(indices);
  RandomStream rng(1);
  const Vec3 from_above{0.6f, 0, 0.8f};
  const auto in = glass.sample(from_above, 0.99f, {}, rng);
  ASSERT_TRUE(in);
  EXPECT_NEAR(in->wi.x, -0.4f, 1e-6f);
  EXPECT_EQ(in->eta, 1.5f);
  const float transmitted = 1 - fresnel_dielectric(0.8f, 1.5f);
  EXPECT_NEAR(in->f[0] * std::abs(in->wi.z), transmitted / 2.25f, 1e-6f);
  EXPECT_NEAR(in->pdf, transmitted, 1e-6f);
  const auto back = glass.sample(in->wi, 0.99f, {}, rng);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->wi.x, from_above.x, 1e-6f);
  EXPECT_NEAR(back->f[0] * std::abs(back->wi.z), transmitted * 2.25f, 1e-5f);
}

/// Where lanes are refracted by different angles, each lane has its own transmittance in the mean over the heroes; with
/// a given hero only this lane continues. From inside at this angle, the first two lanes are reflected totally.
TEST(Dielectric, EveryLaneOfADispersiveGlassHasItsTransmittance) {
  SampledSpectrum eta;
  for (int lane = 0; lane < kLanes; ++lane) eta[lane] = 2 - 0.25f * float(lane);
  const float sine = 0.62f;
  const Vec3 inside{sine, 0, -std::sqrt(1 - sine * sine)};
  for (const bool has_hero : {true, false}) {
    SampledSpectrum sum;
    constexpr int kSamples = 40000;
    for (int i = 0; i < kSamples; ++i) {
      SampledWavelengths lambda = GivenWavelengths({450, 500, 550, 600}).sample(0);
      if (has_hero) lambda.hero = int8_t(i % kLanes);
      const SmoothDielectricBsdf glass(LaneIndices(eta, lambda));
      RandomStream rng(hash_key(3, uint64_t(i)));
      const auto s = glass.sample(inside, rng.uniform(), {}, rng);
      ASSERT_TRUE(s);
      if (!any(s->flags & Lobes::transmission)) continue;
      sum += s->f * (std::abs(s->wi.z) / s->pdf);
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const float expected = (1 - fresnel_dielectric(-inside.z, 1 / eta[lane])) * eta[lane] * eta[lane];
      // Weights are at most 2 eta^2 / 0.4; 5 standard errors: a false alarm in 1.7 million for each of 8.
      EXPECT_NEAR(sum[lane] / kSamples, expected, 5 * 8 / std::sqrt(float(kSamples))) << lane << has_hero;
    }
    EXPECT_EQ(sum[0], 0);
    EXPECT_EQ(sum[1], 0);
  }
}

/// pbrt-v4's mapping: clamp(2 alpha, 0.1, 0.3) below 0.3.
TEST(Regularized, WidthsAreThoseOfPbrt) {
  const std::pair<float, float> expected[] = {{0, 0.1f},    {0.04f, 0.1f}, {0.07f, 0.14f}, {0.14f, 0.28f},
                                              {0.2f, 0.3f}, {0.3f, 0.3f},  {0.5f, 0.5f}};
  for (const auto& [from, to] : expected) {
    EXPECT_FLOAT_EQ(TrowbridgeReitz(from, from).regularized().alpha().x, to) << from;
    EXPECT_FLOAT_EQ(TrowbridgeReitz(from, 0.5f).regularized().alpha().x, to) << from;
    EXPECT_FLOAT_EQ(TrowbridgeReitz(0.5f, from).regularized().alpha().y, to) << from;
  }
}

/// A regularized BSDF is one made of the regularized widths.
TEST(Regularized, BsdfsAreThoseOfTheirWidths) {
  const SampledWavelengths lambda = one_wavelength();
  const LaneIndices glass(SampledSpectrum(1.5f), lambda);
  const ConductorIndices metal(SampledSpectrum(0.2f), SampledSpectrum(3));
  const SampledSpectrum all(1);
  const TrowbridgeReitz narrow(0.06f, 0.02f), smooth(0, 0), wide(0.12f, 0.1f), least(0.1f, 0.1f);
  const Vec3 wo{0.1f, 0.2f, std::sqrt(0.95f)}, up{-0.15f, -0.1f, std::sqrt(1 - 0.0325f)};
  const Vec3 down{-0.1f, -0.1f, -std::sqrt(0.98f)};
  Arena arena;
  const auto expect_same = [&](const Bsdf& from, const Bsdf& to) {
    const Bsdf& found = *from.regularized(arena);
    EXPECT_EQ(found.flags(), to.flags());
    for (const Vec3& wi : {up, down}) {
      RandomStream a(1), b(1);
      EXPECT_EQ(found.f(wo, wi, a), to.f(wo, wi, b));
      EXPECT_EQ(found.pdf(wo, wi), to.pdf(wo, wi));
    }
  };
  expect_same(ConductorBsdf(narrow, metal, all), ConductorBsdf(wide, metal, all));
  expect_same(RoughDielectricBsdf(narrow, glass), RoughDielectricBsdf(wide, glass));
  expect_same(SmoothDielectricBsdf(glass), RoughDielectricBsdf(least, glass));
  const ConductorBase base(smooth, metal, all), wide_base(least, metal, all);
  expect_same(LayeredBsdf<ConductorBase>(narrow, glass, base, {0.1f, {}, 0}, {10, 1}),
              LayeredBsdf<ConductorBase>(wide, glass, wide_base, {0.1f, {}, 0}, {10, 1}));
  const ThinDielectricBsdf pane(glass);
  EXPECT_EQ(pane.regularized(arena), &pane);
  const SmoothDielectricBsdf nothing(LaneIndices(SampledSpectrum(1), lambda));
  EXPECT_EQ(nothing.regularized(arena), &nothing);
}

/// Lambert's reflectance under a smooth coat without medium has a closed form: light that is inside is reflected back
/// by the coat with its mean over all angles. 100000 walks; 6 standard errors, each test fails once in 10^9 by chance.
struct ClosedForm {
  float reflectance, eta;

  double inside() const {
    double sum = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      sum += 2 * cosine * double(fresnel_dielectric(float(cosine), 1 / eta)) / kSteps;
    }
    return sum;
  }
  double f(float cosine_o, float cosine_i) const {
    const double through =
        double(1 - fresnel_dielectric(cosine_o, eta)) * double(1 - fresnel_dielectric(cosine_i, eta));
    return through * double(reflectance * kInvPi) / (double(eta * eta) * (1 - double(reflectance) * inside()));
  }
  double albedo(float cosine_o) const {
    const double outside = double(fresnel_dielectric(cosine_o, eta)), r = double(reflectance);
    return outside + (1 - outside) * r * (1 - inside()) / (1 - r * inside());
  }
};

TEST(Layers, SmoothCoatOverLambertHasItsClosedForm) {
  const ClosedForm expected{0.8f, 1.5f};
  const SampledWavelengths lambda = one_wavelength();
  const LayeredBsdf<DiffuseBase> coated({0, 0}, LaneIndices(SampledSpectrum(1.5f), lambda),
                                        DiffuseBase(SampledSpectrum(0.8f)), {0, {}, 0}, {1000, 1});
  const Vec3 wo{0.6f, 0, 0.8f}, wi{0, -0.8f, 0.6f};
  constexpr int kWalks = 100000;
  double f = 0, f2 = 0, w = 0, w2 = 0;
  for (int i = 0; i < kWalks; ++i) {
    RandomStream rng(hash_key(7, i));
    const double one = double(coated.f(wo, wi, rng)[0]);
    f += one, f2 += one * one;
    const float uc = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    if (const auto s = coated.sample(wo, uc, {u, v}, rng)) {
      const double weight = double(s->f[0] * std::abs(s->wi.z) / s->pdf);
      w += weight, w2 += weight * weight;
    }
  }
  const auto expect_mean = [](double sum, double squares, double mean) {
    const double found = sum / kWalks, error = std::sqrt((squares / kWalks - found * found) / kWalks);
    EXPECT_NEAR(found, mean, 6 * error + 1e-5);
    EXPECT_LT(error, 0.01 * mean);
  };
  expect_mean(f, f2, expected.f(0.8f, 0.6f));
  expect_mean(w, w2, expected.albedo(0.8f));
}

}  // namespace
}  // namespace frond::test
