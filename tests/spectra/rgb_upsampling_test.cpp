#include "spectra/color/rgb_upsampling.h"

#include <gmock/gmock.h>

#include <cmath>

#include "spectra/cie.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::HasSubstr;

class Product final : public Spectrum {
 public:
  Product(const Spectrum& a, const Spectrum& b) : a_(a), b_(b) {}
  float at(float nm) const override { return a_.at(nm) * b_.at(nm); }
  Interval range_nm() const override { return a_.range_nm(); }
  float max_value() const override { return a_.max_value() * b_.max_value(); }

 private:
  const Spectrum &a_, &b_;
};

/// CIE 1976 lightness and opponent colours.
Triple lab(const Triple& xyz, const Triple& white) {
  const auto f = [&](size_t i) {
    const double r = xyz[i] / white[i];
    return r > 216.0 / 24389 ? std::cbrt(r) : (24389.0 / 27 * r + 16) / 116;
  };
  return {116 * f(1) - 16, 500 * (f(0) - f(1)), 200 * (f(1) - f(2))};
}

double distance(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
double largest_difference(const Triple& a, const Triple& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Colours of the whole cube, corners, edges and dark ones included.
template <class Body>
void for_each_color(const Body& body) {
  const double levels[] = {0, 1.0 / 255, 0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 1};
  for (const double r : levels)
    for (const double g : levels)
      for (const double b : levels) body(Triple{r, g, b});
}

const Location kHere{std::make_shared<const std::string>("a.pbrt"), 4, 2};

void must_exist(const std::string& message) { ADD_FAILURE() << message; }

/// Compares the colour of a surface under D65, in the film's linear RGB, with the scene's colour.
void expect_round_trip(const char* name) {
  const ColorSpace& space = *find_color_space(name);
  const Triple nominal_white = kD65White.xyz(), table_white = to_xyz(*unit_d65());
  const Matrix3 to_table_white = bradford(nominal_white, table_white);
  double worst = 0, worst_nominal = 0, worst_delta_e = 0;
  for_each_color([&](const Triple& rgb) {
    const SpectrumPtr s = rgb_albedo(space, rgb, {}, must_exist);
    EXPECT_LE(s->max_value(), 1);
    const Triple xyz = to_xyz(Product(*s, *unit_d65())), wanted = space.xyz_from_rgb * rgb;
    worst = std::max(worst, largest_difference(xyz, to_table_white * wanted));
    worst_nominal = std::max(worst_nominal, largest_difference(space.rgb_from_xyz * xyz, rgb));
    worst_delta_e = std::max(worst_delta_e, distance(lab(xyz, nominal_white), lab(wanted, nominal_white)));
  });
  // The solver stops below 1e-7 of an integral over 1 nm nodes; this one follows the steepest edges.
  EXPECT_LT(worst, 5e-5) << name;
  // The tables' D65 is (0.31272, 0.32903), the standards' (0.3127, 0.3290).
  EXPECT_LT(worst_nominal, 5e-4) << name;
  EXPECT_LT(worst_delta_e, 0.03) << name;
  testing::Test::RecordProperty("xyz", fmt::format("{:.2g}", worst));
  testing::Test::RecordProperty("delta_e", fmt::format("{:.2g}", worst_delta_e));
}

TEST(RgbAlbedo, ColorsComeBackInSrgb) { expect_round_trip("srgb"); }
TEST(RgbAlbedo, ColorsComeBackInSmpteC) { expect_round_trip("smpte-c"); }

/// Additional error of a fit, in XYZ: pure colours of wide spaces have edges that nodes of 1 nm do not resolve.
constexpr double kSteepEdges = 2.5e-3;

TEST(RgbAlbedo, ColorsOfWideSpacesComeBackOrAreTold) {
  const Matrix3 to_table_white = bradford(kD65White.xyz(), to_xyz(*unit_d65()));
  for (const ColorSpace& space : color_spaces()) {
    int kept = 0;
    for_each_color([&](const Triple& rgb) {
      bool exists = true;
      const SpectrumPtr s = rgb_albedo(space, rgb, {}, [&](const std::string&) { exists = false; });
      if (!exists) return;
      const Triple xyz = to_xyz(Product(*s, *unit_d65()));
      EXPECT_LT(largest_difference(xyz, to_table_white * (space.xyz_from_rgb * rgb)), kLargestFitError + kSteepEdges);
      ++kept;
    });
    testing::Test::RecordProperty(std::string(space.name) + " kept of 729", kept);
    EXPECT_GT(kept, 9) << space.name << ": more than the greys";
  }
}

TEST(RgbAlbedo, GreyIsFlatAndExact) {
  for (const float v : {0.f, 0.18f, 0.5f, 1.f})
    for (const ColorSpace& space : color_spaces()) {
      const SpectrumPtr s = rgb_albedo(space, {double(v), double(v), double(v)}, {}, must_exist);
      for (float nm = 360; nm <= 830; nm += 10) ASSERT_EQ(s->at(nm), v);
    }
}

TEST(RgbAlbedo, NearlyGreyIsNearlyFlat) {
  const SpectrumPtr s = rgb_albedo(color_space("srgb", {}), {0.5, 0.5, 0.5001}, {}, must_exist);
  for (float nm = 360; nm <= 830; nm += 10) ASSERT_NEAR(double(s->at(nm)), 0.5, 1e-3);
}

TEST(RgbAlbedo, DataEndWithTheEye) {
  const SpectrumPtr s = rgb_albedo(color_space("srgb", {}), {0.2, 0.5, 0.1}, {}, must_exist);
  EXPECT_EQ(s->range_nm().min, 360);
  EXPECT_EQ(s->range_nm().max, 830);
  EXPECT_EQ(s->at(2000), s->at(830));
}

TEST(RgbAlbedo, MaximumIsThatOfItsValues) {
  for_each_color([](const Triple& rgb) {
    const SpectrumPtr s = rgb_albedo(color_space("srgb", {}), rgb, {}, must_exist);
    float largest = 0;
    for (float nm = 360; nm <= 830; nm += 0.5f) largest = std::max(largest, s->at(nm));
    ASSERT_GE(s->max_value(), largest * (1 - 1e-6f));
    ASSERT_LE(s->max_value(), largest * (1 + 1e-2f) + 1e-6f);
  });
}

TEST(RgbAlbedo, ImpossibleColorsAreRefusedOrTheNearest) {
  const ColorSpace& srgb = *find_color_space("srgb");
  EXPECT_EQ(error_of([&] {
              rgb_albedo(srgb, {1.2, 0, 0}, kHere, must_exist);
            }),
            "a.pbrt:4:2: rgb (1.2, 0, 0) of color space \"srgb\" lies outside 0 to 1");
  EXPECT_THAT(error_of([&] { rgb_albedo(srgb, {0, -0.1, 0}, kHere, must_exist); }), HasSubstr("outside 0 to 1"));
  EXPECT_THAT(error_of([&] { rgb_albedo(srgb, {0, NAN, 0}, kHere, must_exist); }), HasSubstr("outside 0 to 1"));
  std::string warning;
  const SpectrumPtr nearest =
      rgb_albedo(color_space("rec2020", {}), {0, 1, 0}, kHere, [&](const std::string& message) { warning = message; });
  EXPECT_THAT(warning, HasSubstr("brighter and purer than a surface can be"));
  EXPECT_GT(nearest->at(530), 0.9f);
  EXPECT_LT(nearest->at(450), 0.1f);
}

TEST(RgbIlluminant, WhiteIsD65OfUnitLuminanceInEverySpace) {
  for (const ColorSpace& space : color_spaces()) {
    const SpectrumPtr s = rgb_illuminant(space, {1, 1, 1}, {});
    for (float nm = 360; nm <= 830; nm += 5)
      ASSERT_NEAR(s->at(nm), unit_d65()->at(nm), 1e-6f * unit_d65()->max_value());
  }
}

TEST(RgbIlluminant, ColorsComeBackWithTheirLuminance) {
  const Matrix3 to_table_white = bradford(kD65White.xyz(), to_xyz(*unit_d65()));
  for (const char* name : {"srgb", "smpte-c", "rec2020", "dci-p3"}) {
    const ColorSpace& space = *find_color_space(name);
    for_each_color([&](const Triple& rgb) {
      const double scale = 30, largest = std::max({rgb[0], rgb[1], rgb[2]});
      const Triple light{scale * rgb[0], scale * rgb[1], scale * rgb[2]};
      const Triple xyz = to_xyz(*rgb_illuminant(space, light, {}));
      const double bound = scale * largest * (kLargestFitError + kSteepEdges);
      ASSERT_LE(largest_difference(xyz, to_table_white * (space.xyz_from_rgb * light)), bound) << name;
    });
  }
}

TEST(RgbIlluminant, LightPurerThanTheSpectrumIsRefused) {
  EXPECT_THAT(error_of([] {
                rgb_illuminant(color_space("aces2065-1", {}), {0, 0, 1}, kHere);
              }),
              HasSubstr("a.pbrt:4:2: rgb (0, 0, 1) of color space \"aces2065-1\" is purer than any light can be"));
  EXPECT_THAT(error_of([] {
                rgb_illuminant(color_space("srgb", {}), {0, INFINITY, 1}, kHere);
              }),
              HasSubstr("outside 0"));
}

}  // namespace
}  // namespace frond
