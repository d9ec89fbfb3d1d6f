#include "spectra/color/color_management.h"

#include <OpenColorIO/OpenColorIO.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/error.h"
#include "spectra/color/builtin_config.h"
#include "spectra/color/color_space.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Every corner of the cube, greys, and values out of range.
std::vector<float> colors() {
  std::vector<float> rgb;
  for (const float r : {-0.1f, 0.f, 0.18f, 1.f, 7.5f})
    for (const float g : {-0.1f, 0.f, 0.18f, 1.f, 7.5f})
      for (const float b : {-0.1f, 0.f, 0.18f, 1.f, 7.5f}) rgb.insert(rgb.end(), {r, g, b});
  return rgb;
}

Triple pixel(const std::vector<float>& rgb, size_t i) {
  return {double(rgb[3 * i]), double(rgb[3 * i + 1]), double(rgb[3 * i + 2])};
}

void expect_matrix(const std::vector<float>& from, const std::vector<float>& to, const Matrix3& m, double tolerance) {
  for (size_t i = 0; 3 * i < from.size(); ++i) {
    const Triple expected = m * pixel(from, i), is = pixel(to, i);
    for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(is[c], expected[c], tolerance) << "pixel " << i << " channel " << c;
  }
}

/// A configuration file of the user's, and the environment variable that names it.
class UserConfig {
 public:
  explicit UserConfig(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / fmt::format("frond_ocio_{}.ocio", getpid())) {
    std::ofstream(path_) << text;
    setenv("OCIO", path_.c_str(), 1);
  }
  ~UserConfig() {
    unsetenv("OCIO");
    std::filesystem::remove(path_);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string user_config(std::string_view roles) {
  return fmt::format(
      "ocio_profile_version: 2\nroles: {{{} default: linear AP0}}\nfile_rules: [!<Rule> {{name: Default, colorspace: "
      "default}}]\n"
      "displays:\n  TV:\n    - !<View> {{name: Half, colorspace: half}}\n"
      "colorspaces:\n  - !<ColorSpace> {{name: linear AP0}}\n"
      "  - !<ColorSpace>\n    name: half\n    from_scene_reference: !<MatrixTransform> {{matrix: [0.5, 0, 0, 0, 0, "
      "0.5, "
      "0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}}\n",
      roles);
}

class ColorManagement : public ::testing::Test {
 protected:
  ColorManagement() { unsetenv("OCIO"); }
};

// Values reach 7.5: 2e-6 is a few units of the last place of a float there.
constexpr double kFloatRounding = 4e-6;

TEST_F(ColorManagement, EveryLinearSpaceAgreesWithItsMatrixBothWays) {
  const ColorManager manager;
  for (const ColorSpace& s : color_spaces()) {
    const auto rgb = colors();
    auto there = rgb, back = rgb;
    manager.convert(there, s.linear_name, "XYZ");
    expect_matrix(rgb, there, s.xyz_from_rgb, kFloatRounding);
    manager.convert(back, "XYZ", s.linear_name);
    expect_matrix(rgb, back, s.rgb_from_xyz, 4 * kFloatRounding);
  }
}

TEST_F(ColorManagement, SmpteCToXyzHasThePublishedFigures) {
  std::vector<float> rgb{1, 0, 0, 0, 1, 0, 0, 0, 1};
  ColorManager().convert(rgb, "linear SMPTE-C", "XYZ");
  const std::vector<double> expected{0.39352090, 0.21237636, 0.01873909, 0.36525808, 0.70105986,
                                     0.11193393, 0.19167695, 0.08656378, 0.95838473};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(double(rgb[i]), expected[i], 1e-7);
}

TEST_F(ColorManagement, AnyToAnyIsTheProductOfMatrices) {
  const ColorManager manager;
  for (const ColorSpace& a : color_spaces())
    for (const ColorSpace& b : color_spaces()) {
      const auto rgb = colors();
      auto converted = rgb;
      manager.convert(converted, a.linear_name, b.linear_name);
      expect_matrix(rgb, converted, b.rgb_from_xyz * a.xyz_from_rgb, 4 * kFloatRounding);
    }
}

double srgb_curve(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }
double smpte170_curve(double v) { return v < 0.018 ? 4.5 * v : 1.099 * std::pow(v, 0.45) - 0.099; }

/// Grey ramp through a display: white and grey of any space stay grey, so that the curve shows alone.
void expect_curve(std::string_view display, double (*curve)(double)) {
  const ColorManager manager;
  for (int i = 0; i <= 1000; ++i) {
    const float v = static_cast<float>(i) / 1000;
    std::vector<float> rgb{v, v, v};
    manager.display(rgb, "linear SMPTE-C", display, "Standard");
    // The standards' constants are rounded: their two pieces do not quite meet, OpenColorIO's do. 2.5e-4 in the toe of
    // SMPTE 170M, a fifteenth of a step of 8 bits.
    for (const float c : rgb) ASSERT_NEAR(double(c), curve(double(v)), 2.6e-4) << display << " " << v;
  }
}

TEST_F(ColorManagement, DisplaysHaveTheirStandardsCurves) {
  expect_curve("sRGB", srgb_curve);
  expect_curve("SMPTE-C", smpte170_curve);
}

TEST_F(ColorManagement, DisplaysHaveTheirStandardsPrimaries) {
  const ColorManager manager;
  const auto rgb = std::vector<float>{0.5f, 0.2f, 0.1f};
  auto shown = rgb;
  manager.display(shown, "linear SMPTE-C", "sRGB", "Standard");
  const Triple linear =
      color_space("srgb", {}).rgb_from_xyz * (color_space("smpte-c", {}).xyz_from_rgb * pixel(rgb, 0));
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(double(shown[c]), srgb_curve(linear[c]), 1e-4);
}

TEST_F(ColorManagement, RawViewsShowTheValuesAsTheyAre) {
  for (const char* display : {"sRGB", "SMPTE-C"}) {
    auto rgb = colors();
    ColorManager().display(rgb, "ACEScg", display, "Raw");
    EXPECT_EQ(rgb, colors());
  }
}

TEST_F(ColorManagement, DefaultsAreSrgbAndStandard) {
  const ColorManager manager;
  std::vector<float> a{0.5f, 0.2f, 0.1f}, b = a;
  manager.display(a, "XYZ", "", "");
  manager.display(b, "XYZ", "sRGB", "Standard");
  EXPECT_EQ(a, b);
  EXPECT_THAT(manager.displays(), ElementsAre("sRGB", "SMPTE-C"));
  EXPECT_THAT(manager.views("SMPTE-C"), ElementsAre("Standard", "Raw"));
  EXPECT_EQ(manager.source(), "built-in");
}

/// Values of the sRGB display of OpenColorIO's cg-config-v1.0.0_aces-v1.3_ocio-v2.1, from ACES2065-1.
TEST_F(ColorManagement, TheAcesViewIsThatOfTheAcesConfigurations) {
  std::vector<float> rgb{0.18f, 0.18f, 0.18f, 1, 1, 1, 0.05f, 0.08f, 0.03f, 8, 8, 8};
  const ColorManager manager;
  manager.display(rgb, "ACES2065-1", "sRGB", "ACES 1.0 - SDR Video");
  const std::vector<double> expected{0.355952, 0.355953, 0.355953, 0.811975, 0.811975, 0.811975,
                                     0.036138, 0.214535, 0.058260, 0.984430, 0.984430, 0.984430};
  for (size_t i = 0; i < rgb.size(); ++i) EXPECT_NEAR(double(rgb[i]), expected[i], 2e-5) << i;
}

/// The form of the ACES configurations: a reference space that is ACES2065-1, scene-referred spaces, a shared view
/// transform and displays.
TEST_F(ColorManagement, AnAcesConfigurationOfTheUserWorks) {
  const UserConfig file(R"(ocio_profile_version: 2
roles: {aces_interchange: ACES2065-1, cie_xyz_d65_interchange: CIE-XYZ-D65, default: ACES2065-1}
file_rules: [!<Rule> {name: Default, colorspace: default}]
shared_views: [!<View> {name: ACES 1.0 - SDR Video, view_transform: SDR, display_colorspace: <USE_DISPLAY_NAME>}]
displays: {"sRGB - Display": [!<Views> [ACES 1.0 - SDR Video]]}
view_transforms:
  - !<ViewTransform>
    name: SDR
    from_scene_reference: !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0}
display_colorspaces:
  - !<ColorSpace> {name: CIE-XYZ-D65}
  - !<ColorSpace>
    name: sRGB - Display
    from_display_reference: !<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_sRGB}
colorspaces: [!<ColorSpace> {name: ACES2065-1}]
)");
  auto theirs = colors(), ours = colors();
  ColorManager().display(theirs, "linear SMPTE-C", "", "");
  unsetenv("OCIO");
  ColorManager().display(ours, "linear SMPTE-C", "sRGB", "ACES 1.0 - SDR Video");
  for (size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(double(theirs[i]), double(ours[i]), 2e-5) << i;
}

/// OpenColorIO has built-in configurations since 2.2; with older versions, the message says so.
TEST_F(ColorManagement, OpenColorIOsOwnConfigurations) {
  if (OCIO_NAMESPACE::GetVersionHex() < 0x02020000) {
    EXPECT_THAT(error_of([] { ColorManager("ocio://default"); }),
                AllOf(HasSubstr("2.2 and later have"), HasSubstr("OpenColorIO-Config-ACES")));
    return;
  }
  auto theirs = colors(), ours = colors();
  ColorManager("ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1").display(theirs, "linear sRGB", "", "");
  ColorManager().display(ours, "linear sRGB", "sRGB", "ACES 1.0 - SDR Video");
  for (size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(double(theirs[i]), double(ours[i]), 2e-5) << i;
  EXPECT_FALSE(ColorManager("ocio://default").displays().empty());
}

TEST_F(ColorManagement, UnknownNamesAreAnsweredWithWhatThereIs) {
  const ColorManager manager;
  std::vector<float> rgb{0, 0, 0};
  EXPECT_EQ(error_of([&] { manager.display(rgb, "XYZ", "rsGB", ""); }),
            "unknown display \"rsGB\"; did you mean \"sRGB\"?");
  EXPECT_EQ(error_of([&] { manager.check_display("XYZ", "sRGB", "Filmic"); }),
            "unknown view of display sRGB \"Filmic\"; there are \"Standard\", \"ACES 1.0 - SDR Video\", \"Raw\"");
  EXPECT_THAT(error_of([&] { manager.convert(rgb, "linear SMPTE", "XYZ"); }),
              HasSubstr("unknown color space \"linear SMPTE\"; did you mean \"linear SMPTE-C\"?"));
}

TEST_F(ColorManagement, EnvironmentNamesTheConfigurationAndOurSpacesStillConvert) {
  const UserConfig file(user_config("aces_interchange: linear AP0,"));
  const ColorManager manager;
  EXPECT_EQ(manager.source(), file.path().string());
  EXPECT_THAT(manager.displays(), ElementsAre("TV"));
  EXPECT_THAT(manager.spaces(), Contains("linear SMPTE-C"));
  const auto rgb = colors();
  auto shown = rgb;
  manager.display(shown, "linear SMPTE-C", "TV", "Half");
  const Matrix3 aces = color_space("aces2065-1", {}).rgb_from_xyz * color_space("smpte-c", {}).xyz_from_rgb;
  expect_matrix(rgb, shown, Matrix3::diagonal({0.5, 0.5, 0.5}) * aces, 4 * kFloatRounding);
  auto converted = rgb;
  manager.convert(converted, "half", "XYZ");
  expect_matrix(rgb, converted, color_space("aces2065-1", {}).xyz_from_rgb * Matrix3::diagonal({2, 2, 2}), 1e-4);
}

TEST_F(ColorManagement, ConfigurationWithoutInterchangeConvertsItsOwnSpacesOnly) {
  const UserConfig file(user_config(""));
  const ColorManager manager;
  std::vector<float> rgb{1, 1, 1};
  manager.convert(rgb, "linear AP0", "half");
  EXPECT_THAT(rgb, ElementsAre(0.5f, 0.5f, 0.5f));
  EXPECT_THAT(error_of([&] { manager.display(rgb, "linear SMPTE-C", "", ""); }), HasSubstr("(role aces_interchange)"));
}

TEST_F(ColorManagement, UnreadableConfigurationIsNamed) {
  EXPECT_THAT(error_of([] { ColorManager("/nowhere/config.ocio"); }),
              HasSubstr("cannot read the OpenColorIO configuration \"/nowhere/config.ocio\""));
  const UserConfig file("this is: [not a configuration");
  EXPECT_THAT(error_of([] { ColorManager manager; }), HasSubstr(file.path().string()));
}

}  // namespace
}  // namespace frond
