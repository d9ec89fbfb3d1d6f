// Virtual radiometers under the light "sky".

#include <gmock/gmock.h>

#include <numbers>

#include "image/image_file.h"
#include "radiometry/brf.h"
#include "radiometry/flux.h"
#include "radiometry/horizontal_irradiance.h"
#include "scene/format/parser.h"
#include "scene/scene_options.h"
#include "spectra/csv_columns.h"
#include "system/file_bytes.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

// Each comparison allows 4.5 standard errors: a false alarm of 7e-6 each.
constexpr double kZ = 4.5;

std::string sky(const std::string& params) { return "LightSource \"sky\" " + params + "\n"; }

/// Two leaves above a soil, all Lambertian.
const std::string kLeaves =
    "MakeNamedMaterial \"soil\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0.3 2500 0.3]\n"
    "MakeNamedMaterial \"leaf\" \"string type\" \"diffusetransmission\" \"spectrum reflectance\" [300 0.4 2500 0.4] "
    "\"spectrum transmittance\" [300 0.3 2500 0.3]\n"
    "NamedMaterial \"soil\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 2 0  2 2 0]\n"
    "NamedMaterial \"leaf\"\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0.2 0.2 0.5  1.2 0.2 0.7  0.2 1 0.6  1.2 1 0.3]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0.8 0.6 0.9  1.8 0.6 0.7  0.8 1.8 1.0  1.8 1.8 1.4]\n";

SceneDescription description(const std::string& world) {
  return parse_scene_text("WorldBegin\n" + world, "t", silent_log());
}

TEST(SkyRadiometry, TheHorizontalIrradianceIsThatOfSpectrl2AtEveryWavelength) {
  const auto t = csv_columns(read_file_bytes(FROND_SOURCE_DIR "/tests/reference/spectrl2.csv", {}));
  constexpr size_t kWavelengths = 107;
  std::string bands = "bands,wavelengths=";
  for (size_t i = 0; i < kWavelengths; ++i) bands += fmt::format("{}{}", i ? "," : "", t[8][i]);
  for (size_t begin = 0; begin < t[0].size(); begin += kWavelengths) {
    const std::string world = sky(fmt::format(
        "\"float elevation\" {} \"float azimuth\" 77 \"float aerosol\" {} \"float angstrom\" {} \"float water\" {} "
        "\"float ozone\" {} \"float pressure\" {} \"float albedo\" {} \"integer day\" {}",
        90 - t[0][begin], t[1][begin], t[2][begin], t[3][begin], t[4][begin], t[5][begin], t[6][begin], t[7][begin]));
    Session session(silent_log(), {1, {}, {}});
    SceneDescription d = description(world + kLeaves);
    set_wavelengths(d, bands);
    const LoadedScene loaded = session.load(std::move(d));
    const HorizontalIrradiance e(loaded);
    for (size_t i = 0; i < kWavelengths; ++i) {
      const double expected = t[10][begin + i] * std::cos(t[0][begin] * std::numbers::pi / 180) + t[11][begin + i];
      EXPECT_NEAR(e.bands()[i], expected, 1e-3 * expected) << t[8][begin + i] << " nm, zenith " << t[0][begin];
    }
  }
}

TEST(SkyRadiometry, SharesOfTheLightAddUpToOne) {
  for (const char* params : {"", "\"float elevation\" 8 \"float aerosol\" 0.4", "\"string sky\" \"overcast\""}) {
    Session session(silent_log(), {2, {}, {}});
    FluxMeter meter(session, description(sky(params) + kLeaves),
                    {.period = std::array{2.0, 2.0}, .wavelengths = "bands,wavelengths=400,550,1650"});
    meter.trace(1 << 17, session.pool());
    const FluxMeasurement flux = meter.read();
    for (const MeanError& sum : flux.sum) {
      EXPECT_NEAR(sum.mean, 1, kZ * sum.standard_error + 1e-3) << params;  // 1e-3: of the irradiance, see above
      EXPECT_LT(sum.standard_error, 3e-3) << params;
    }
  }
}

/// One texel, of about the solid angle of the sun, sends five times the light of all others.
TEST(SkyRadiometry, ASunInAnImageOfTheSkyIsSampled) {
  constexpr int kSide = 512;
  const TestFolder folder("painted_sun");
  Image image(kSide, kSide, {"R", "G", "B"});
  std::ranges::fill(image.pixels, 1.f);
  for (size_t c = 0; c < 3; ++c) image.at(kSide / 2 + 60, kSide / 2 + 40, c) = 5.f * kSide * kSide;
  write_image(folder.name_of("sky.exr"), image, {"linear sRGB", {}});
  Session session(silent_log(), {2, {}, {}});
  FluxMeter meter(
      session,
      description(fmt::format("LightSource \"infinite\" \"string filename\" \"{}\"\n", folder.name_of("sky.exr")) +
                  kLeaves),
      {.period = std::array{2.0, 2.0}, .wavelengths = "bands,wavelengths=550"});
  meter.trace(1 << 15, session.pool());
  const MeanError sum = meter.read().sum[0];
  EXPECT_LT(sum.standard_error, 0.01);  // with the cosine only one path in 90,000 would begin at this sun
  EXPECT_NEAR(sum.mean, 1, kZ * sum.standard_error + 1e-3);
}

TEST(SkyRadiometry, APanelsReflectanceFactorIsItsReflectanceInEveryDirection) {
  const std::string panel =
      "Material \"diffuse\" \"spectrum reflectance\" [300 0.7 2500 0.7]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n";
  Session session(silent_log(), {2, {}, {}});
  const BrfMeter meter(session, description(sky("\"float elevation\" 30 \"float azimuth\" 200") + panel),
                       {.views = {{0, 0}, {-60, 0}, {60, 90}}, .wavelengths = "bands,wavelengths=350,700,2200"});
  RenderPart part = meter.scene().empty_part();
  session.render(meter.scene(), {0, 256}, part);
  const BrfMeasurement brf = meter.read(part.film);
  EXPECT_EQ(brf.quantity, "HDRF");
  for (const MeanError& value : brf.values) EXPECT_NEAR(value.mean, 0.7, kZ * value.standard_error + 7e-4);
}

TEST(SkyRadiometry, AzimuthZeroIsThePlaneOfTheSkysSun) {
  Session session(silent_log(), {1, {}, {}});
  const auto sun = [&](const std::string& lights) {
    const LoadedScene loaded = session.load(description(lights + kLeaves));
    return direction_to_sun(loaded.scene().lights());
  };
  const auto toward = sun(sky("\"float elevation\" 30 \"float azimuth\" 90"));
  ASSERT_TRUE(toward);
  EXPECT_NEAR(toward->y, std::sqrt(0.75), 1e-6);
  EXPECT_FALSE(sun(sky("\"string sky\" \"overcast\"")));
  EXPECT_FALSE(
      sun(sky("") +
          "LightSource \"distant\" \"point3 from\" [0 1 1] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n"));
}

}  // namespace
}  // namespace frond
