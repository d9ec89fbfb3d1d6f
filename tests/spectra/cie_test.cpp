#include "spectra/cie.h"

#include <gtest/gtest.h>

#include "spectra/analytic.h"
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

TEST(Cie, D65HasItsPublishedChromaticity) {
  const Triple xyz = to_xyz(*d65());
  const double sum = xyz[0] + xyz[1] + xyz[2];
  EXPECT_NEAR(xyz[0] / sum, 0.31272, 3e-5);
  EXPECT_NEAR(xyz[1] / sum, 0.32903, 3e-5);
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
