#include "spectra/cie.h"

#include <gtest/gtest.h>

#include "spectra/analytic.h"
#include "spectra/illuminants.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

TEST(Cie, MatchingFunctionsHoldTheTableAndAreLinearBetween) {
  EXPECT_EQ(cie_xyz(360)[0], 0.0001299);
  EXPECT_EQ(cie_xyz(555)[1], 1.0);
  const Triple a = cie_xyz(600), b = cie_xyz(605), middle = cie_xyz(602.5);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(middle[i], (a[i] + b[i]) / 2, 1e-12);
}

TEST(Cie, NothingIsSeenOutsideTheTable) {
  for (const double nm : {100.0, 359.999, 830.001, 2500.0}) EXPECT_EQ(cie_xyz(nm), Triple{}) << nm;
  EXPECT_GT(cie_xyz(830)[1], 0);
}

TEST(Cie, EqualEnergyIsNearlyWhite) {
  const Triple xyz = to_xyz(ConstantSpectrum(1));
  // The standard's own sums at 5 nm agree to 1e-4 with one another; ybar's is 106.857 nm.
  EXPECT_NEAR(xyz[1], 106.857, 0.01);
  EXPECT_NEAR(xyz[0] / xyz[1], 1, 2e-4);
  EXPECT_NEAR(xyz[2] / xyz[1], 1, 4e-4);
}

void expect_chromaticity(const Spectrum& s, double x, double y, double tolerance) {
  const Triple xyz = to_xyz(s);
  const double sum = xyz[0] + xyz[1] + xyz[2];
  EXPECT_NEAR(xyz[0] / sum, x, tolerance);
  EXPECT_NEAR(xyz[1] / sum, y, tolerance);
}

// Tolerances allow for steps of five nanometres and the rounding of the tables.
TEST(Cie, IlluminantsHaveTheirPublishedChromaticities) {
  expect_chromaticity(*d65(), 0.31272, 0.32903, 3e-5);
  expect_chromaticity(*illuminant_a(), 0.44758, 0.40745, 3e-5);
  expect_chromaticity(*illuminant_e(), 1.0 / 3, 1.0 / 3, 6e-5);
}

TEST(Cie, IlluminantAHasItsPublishedValues) {
  const std::pair<float, double> published[] = {{300.f, 0.930483}, {380.f, 9.79510}, {400.f, 14.7080},
                                                {500.f, 59.8611},  {560.f, 100},     {600.f, 129.043},
                                                {700.f, 198.261},  {780.f, 241.675}};
  for (const auto& [nm, value] : published) EXPECT_NEAR(double(illuminant_a()->at(nm)), value, 5e-6 * value) << nm;
}

TEST(Cie, IlluminantAIsABlackbodyWithTheConstantOf1931) {
  const BlackbodySpectrum blackbody(2848 * 1.438776877 / 1.435);
  for (float nm = 300; nm <= 830; nm += 10)
    EXPECT_NEAR(illuminant_a()->at(nm), 100 * blackbody.at(nm) / blackbody.at(560), 3e-4f) << nm;
}

TEST(Cie, IlluminantsEndWhereTheyAreDefined) {
  EXPECT_EQ(illuminant_a()->range_nm().min, 300);
  EXPECT_EQ(illuminant_a()->range_nm().max, 830);
  EXPECT_EQ(illuminant_a()->at(900), illuminant_a()->at(830));
  EXPECT_EQ(illuminant_a()->max_value(), illuminant_a()->at(830));
  EXPECT_EQ(illuminant_e()->range_nm().max, 2500);
}

TEST(Cie, D65IsNormalisedAsPublishedAndToUnitLuminance) {
  EXPECT_EQ(d65()->at(560), 100);
  EXPECT_EQ(d65()->range_nm().max, 830);
  EXPECT_NEAR(photometric(*unit_d65()), 1, 1e-6);
}

TEST(Cie, UnitLuminanceLeavesBlackAlone) {
  EXPECT_EQ(unit_luminance(std::make_shared<ConstantSpectrum>(0.f))->max_value(), 0);
  EXPECT_NEAR(photometric(*unit_luminance(std::make_shared<BlackbodySpectrum>(2856))), 1, 1e-6);
}

}  // namespace
}  // namespace frond
