#include "spectra/color/color_space.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "spectra/cie.h"

namespace frond {
namespace {

void expect_near(const Matrix3& a, const Matrix3& b, double tolerance) {
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) EXPECT_NEAR(a.row[i][j], b.row[i][j], tolerance) << i << "," << j;
}

TEST(ColorSpace, SmpteCMatrixIsThePublishedOne) {
  expect_near(color_space("smpte-c", {}).xyz_from_rgb,
              {{{{0.39352090, 0.36525808, 0.19167695},
                 {0.21237636, 0.70105986, 0.08656378},
                 {0.01873909, 0.11193393, 0.95838473}}}},
              5e-9);
}

TEST(ColorSpace, SrgbMatrixIsThatOfTheStandard) {
  // IEC 61966-2-1 prints four digits.
  expect_near(color_space("srgb", {}).xyz_from_rgb,
              {{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}}}, 7e-5);
}

TEST(ColorSpace, AcesApZeroMatrixIsThatOfTheStandard) {
  // SMPTE ST 2065-1 prints ten digits; relative to its own white.
  expect_near(xyz_from_rgb(color_space("aces2065-1", {}).chromaticities),
              {{{{0.9525523959, 0, 0.0000936786}, {0.3439664498, 0.7281660966, -0.0721325464}, {0, 0, 1.0088251844}}}},
              5e-11);
}

TEST(ColorSpace, EveryWhiteIsD65AndEveryMatrixInverts) {
  const Triple white = kD65White.xyz();
  for (const ColorSpace& s : color_spaces()) {
    const Triple xyz = s.xyz_from_rgb * Triple{1, 1, 1};
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(xyz[i], white[i], 1e-12) << s.name;
    expect_near(s.rgb_from_xyz * s.xyz_from_rgb, Matrix3::diagonal({1, 1, 1}), 1e-12);
  }
}

TEST(ColorSpace, BradfordFromD50ToD65IsThePublishedOne) {
  // Lindbloom's table for whites (0.96422, 1, 0.82521) and (0.95047, 1, 1.08883), seven digits.
  expect_near(
      bradford({0.96422, 1, 0.82521}, {0.95047, 1, 1.08883}),
      {{{{0.9555766, -0.0230393, 0.0631636}, {-0.0282895, 1.0099416, 0.0210077}, {0.0122982, -0.0204830, 1.3299098}}}},
      1e-6);
}

TEST(ColorSpace, NamesAreThoseOfScenesAndUnknownOnesAreRefused) {
  for (const char* name : {"aces2065-1", "rec2020", "dci-p3", "srgb", "smpte-c", "acescg"})
    EXPECT_EQ(color_space(name, {}).name, name);
  EXPECT_EQ(color_space("linear SMPTE-C", {}).name, "smpte-c");
  try {
    color_space("sgrb", {std::make_shared<const std::string>("a.pbrt"), 2, 1});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "a.pbrt:2:1: unknown color space \"sgrb\"; did you mean \"srgb\"?");
  }
}

TEST(ColorSpace, ChromaticitiesOfXyzAreItsCorners) {
  ASSERT_NE(chromaticities_of("XYZ"), nullptr);
  EXPECT_EQ(chromaticities_of("XYZ")->red.x, 1);
  EXPECT_EQ(chromaticities_of("linear SMPTE-C")->blue.y, 0.070);
  EXPECT_EQ(chromaticities_of("nonsense"), nullptr);
}

/// xy of the spectral locus, by Lagrange's cubic through the four nearest entries of the 5 nm table. Linear between
/// them, as a render takes it, the red primary's wavelength comes out 0.2 nm longer.
Chromaticity locus(double nm) {
  const double first = 5 * std::floor(nm / 5), t = (nm - first) / 5;
  const double weights[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                            (t + 1) * t * (t - 1) / 6};
  Triple xyz{};
  for (int i = 0; i < 4; ++i)
    for (size_t c = 0; c < 3; ++c) xyz[c] += weights[i] * cie_xyz(first + 5 * (i - 1))[c];
  const double sum = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / sum, xyz[1] / sum};
}

/// Where the ray from white through a colour meets the spectral locus, to 0.01 nm.
double dominant_wavelength_nm(const Chromaticity& c, const Chromaticity& white) {
  const double target = std::atan2(c.y - white.y, c.x - white.x);
  const auto turn = [&](double nm) {
    const auto [x, y] = locus(nm);
    return std::remainder(std::atan2(y - white.y, x - white.x) - target, 2 * std::numbers::pi);
  };
  for (double nm = 400; nm < 700; nm += 0.01)
    if (turn(nm) >= 0 && turn(nm + 0.01) < 0 && turn(nm) < 1) return nm + 0.005;
  return 0;
}

TEST(ColorSpace, DominantWavelengthsOfTheSmpteCPrimaries) {
  // The paper's 608, 551 and 455 nm: its blue is off by 10 nm.
  const Chromaticities& c = find_color_space("smpte-c")->chromaticities;
  EXPECT_NEAR(dominant_wavelength_nm(c.red, c.white), 607.9, 0.05);
  EXPECT_NEAR(dominant_wavelength_nm(c.green, c.white), 551.0, 0.06);
  EXPECT_NEAR(dominant_wavelength_nm(c.blue, c.white), 464.7, 0.05);
}

}  // namespace
}  // namespace frond
