#include "image/exposure.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Grey pixels of these values, in rows of 10.
Image grey(const std::vector<float>& values) {
  Image image(10, int(values.size()) / 10, {"R", "G", "B"});
  for (size_t i = 0; i < values.size(); ++i)
    image.pixels[3 * i] = image.pixels[3 * i + 1] = image.pixels[3 * i + 2] = values[i];
  return image;
}

TEST(Exposure, IsANumberOrAuto) {
  EXPECT_EQ(parse_exposure("auto"), (ExposureChoice{0, true}));
  EXPECT_EQ(parse_exposure("-1.5"), (ExposureChoice{-1.5, false}));
  EXPECT_EQ(parse_exposure("+2"), (ExposureChoice{2, false}));
  for (const char* text : {"", "x", "1x", "65", "-65", "nan", "inf", "1e400", "AUTO"})
    EXPECT_EQ(parse_exposure(text), std::nullopt) << text;
}

/// An even image of 0.18 / 2^n needs n stops, whatever its space; the third of a stop is given by two digits.
TEST(Exposure, AnEvenImageBecomesMidGrey) {
  for (const double stops : {-2., 0., 1., 7. / 3}) {
    Image image = grey(std::vector<float>(100, float(0.18 * std::exp2(-stops))));
    for (const char* space : {"linear sRGB", "ACEScg", "a space of a configuration"})
      EXPECT_EQ(measure_exposure(image, space).stops, std::round(stops * 100) / 100) << space;
    expose(image, stops);
    EXPECT_NEAR(image.pixels[0], 0.18, 1e-6);
  }
}

TEST(Exposure, BlackPixelsDoNotCountAndHighlightsLimitIt) {
  std::vector<float> values(1000, 0.f);
  std::fill_n(values.begin(), 100, 0.045f);
  EXPECT_NEAR(measure_exposure(grey(values), "linear sRGB").stops, 2, 1e-9);
  std::fill_n(values.begin(), 10, 0.5f);  // a tenth of those with light
  EXPECT_NEAR(measure_exposure(grey(values), "linear sRGB").stops, 1, 1e-9);
  EXPECT_EQ(measure_exposure(grey(std::vector<float>(100, 0.f)), "linear sRGB").stops, 0);
  values[500] = std::numeric_limits<float>::quiet_NaN();
  values[501] = -1;
  EXPECT_NEAR(measure_exposure(grey(values), "linear sRGB").stops, 1, 1e-9);
}

TEST(Exposure, IsSuggestedForBlackAndForClippedImages) {
  const auto advice = [](const std::vector<float>& values) {
    return exposure_advice(measure_exposure(grey(values), "linear sRGB"), "--exposure");
  };
  EXPECT_THAT(advice(std::vector<float>(100, 0.0009f)), AllOf(HasSubstr("nearly all of the image is too dark"),
                                                              HasSubstr("--exposure auto"), HasSubstr("+7.67 stops")));
  EXPECT_THAT(advice(std::vector<float>(100, 18.f)),
              AllOf(HasSubstr("100 % of the image is brighter than white"), HasSubstr("-6.67 stops")));
  EXPECT_EQ(advice(std::vector<float>(100, 0.05f)), "");
  EXPECT_EQ(advice(std::vector<float>(100, 0.f)), "");
}

TEST(Exposure, StopsHaveASign) {
  EXPECT_EQ(stops_text(4. / 3), "+1.33");
  EXPECT_EQ(stops_text(-2), "-2");
  EXPECT_EQ(stops_text(-0.001), "0");
}

}  // namespace
}  // namespace frond
