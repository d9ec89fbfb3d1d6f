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
