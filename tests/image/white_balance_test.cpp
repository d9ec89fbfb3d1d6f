#include "image/white_balance.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace frond {
namespace {

TEST(WhiteBalance, IsATemperatureOrAuto) {
  EXPECT_EQ(parse_white("auto"), (WhiteChoice{0, true}));
  EXPECT_EQ(parse_white("2856"), (WhiteChoice{2856, false}));
  for (const char* text : {"", "warm", "999", "1e6", "-5000", "nan", "5000K"})
    EXPECT_EQ(parse_white(text), std::nullopt) << text;
}

/// CIE 15:2004: D65 is daylight of 6504 K by the present scale, 6500 K of 1931; a blackbody of 2856 K by the present
/// scale is illuminant A (0.4476, 0.4074).
TEST(WhiteBalance, WhitesAreThoseOfTheCie) {
  EXPECT_NEAR(daylight_white(6500).x, 0.3127, 2e-4);
  EXPECT_NEAR(daylight_white(6500).y, 0.3290, 2e-4);
  EXPECT_NEAR(daylight_white(2856).x, 0.4476, 1e-3);
  EXPECT_NEAR(daylight_white(2856).y, 0.4074, 1e-3);
}

TEST(WhiteBalance, ThatWhiteBecomesNeutralInEverySpace) {
  const Chromaticity lamp{0.4476, 0.4074};
  for (const ColorSpace& space : color_spaces()) {
    Image image(1, 1, {"R", "G", "B", "leaf"});
    const Triple rgb = space.rgb_from_xyz * lamp.xyz();
    for (size_t c = 0; c < 3; ++c) image.pixels[c] = float(rgb[c]);
    image.pixels[3] = 0.25f;
    balance_white(image, space.linear_name, lamp);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[c], 1, 2e-3) << space.name;
    EXPECT_EQ(image.pixels[3], 0.25f);
  }
  Image image(1, 1, {"X", "Y", "Z"});
  EXPECT_NE(error_of([&] { balance_white(image, "no space", lamp); }), "");
}

TEST(WhiteBalance, ChromaticitiesAreText) {
  const auto c = parse_chromaticity(chromaticity_text({0.3127, 0.329}));
  ASSERT_TRUE(c);
  EXPECT_EQ(c->x, 0.3127);
  EXPECT_EQ(c->y, 0.329);
  for (const char* text : {"", "0.3", "0.3 0", "0.3 x", "0.3 0.3 0.3", "0.3,0.3", "nan 0.3", "0.3 1e-9"})
    EXPECT_FALSE(parse_chromaticity(text)) << text;
}

}  // namespace
}  // namespace frond
