#include "spectra/color/reflectance_table.h"

#include <gtest/gtest.h>

#include "core/math/random.h"
#include "spectra/cie.h"
#include "spectra/illuminants.h"

namespace frond {
namespace {

/// Returns the colour of a reflectance under D65, in linear sRGB.
Triple shown(const SigmoidPolynomial& s) {
  Triple xyz{}, white{};
  for (int nm = 360; nm <= 830; ++nm)
    for (size_t k = 0; k < 3; ++k) {
      const double w = cie_xyz(nm)[k] * double(unit_d65()->at(float(nm)));
      xyz[k] += w * double(s.at(float(nm)));
      white[k] += w;
    }
  return bradford(white, kD65White.xyz()) * xyz;
}

TEST(ReflectanceTable, ColoursComeBack) {
  const ReflectanceTable& table = ReflectanceTable::srgb();
  const ColorSpace& space = *find_color_space("srgb");
  RandomStream random(3);
  double mean = 0, worst = 0;
  constexpr int kColors = 2000;
  for (int i = 0; i < kColors; ++i) {
    const Float4 rgb{random.uniform(), random.uniform(), random.uniform(), 0};
    const Triple wanted = space.xyz_from_rgb * Triple{double(rgb[0]), double(rgb[1]), double(rgb[2])};
    const Triple xyz = shown(table.at(rgb));
    double error = 0;
    for (size_t k = 0; k < 3; ++k) error = std::max(error, std::abs(xyz[k] - wanted[k]));
    mean += error / kColors, worst = std::max(worst, error);
  }
  EXPECT_LT(mean, 1e-3);
  EXPECT_LT(worst, 2e-2);  // of the purest and brightest
}

TEST(ReflectanceTable, GreysAreFlatAndCornersHaveNumbers) {
  const ReflectanceTable& table = ReflectanceTable::srgb();
  SampledWavelengths lambda;
  lambda.count = 3, lambda.nm = {400, 550, 700, 0};
  for (const float v : {0.f, 1e-4f, 0.18f, 0.5f, 0.9f, 1.f}) {
    const SampledSpectrum s = table.sample(Float4{v, v, v, 0}, lambda);
    for (int lane = 0; lane < 3; ++lane) EXPECT_EQ(s[lane], v);
    EXPECT_EQ(s[3], 0);
  }
  for (int corner = 0; corner < 8; ++corner)
    for (const float nm : {360.f, 450.f, 550.f, 700.f, 830.f}) {
      const float v = table.at(Float4{float(corner & 1), float(corner >> 1 & 1), float(corner >> 2), 0}).at(nm);
      EXPECT_TRUE(v >= 0 && v <= 1) << corner << ' ' << nm;
    }
}

}  // namespace
}  // namespace frond
