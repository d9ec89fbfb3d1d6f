// LightSource "sky" scaled to the irradiances of a weather station, and the position of the sun.

#include <gmock/gmock.h>

#include <numbers>

#include "core/log.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "spectra/spectrl2.h"
#include "spectra/sun_position.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kSine = 0.5;  // of an elevation of 30 degrees

/// Warnings of a sky, and the energy of its light on a horizontal plane from 300 to 2500 nm, W/m^2.
struct Energy {
  double direct = 0, diffuse = 0, diffuse_par = 0;
  std::vector<std::string> warnings = {};

  explicit Energy(const std::string& params) {
    class Keep final : public Log {
     public:
      explicit Keep(std::vector<std::string>& warnings) : warnings_(warnings) {}
      void info(std::string_view) const override {}
      void warn(const Location&, std::string_view message) const override { warnings_.emplace_back(message); }

     private:
      std::vector<std::string>& warnings_;
    };
    const Keep log(warnings);
    const ClearSkyIrradiance model = spectrl2({.sun_zenith_deg = 60});
    SceneDescription d =
        parse_scene_text("WorldBegin\nLightSource \"sky\" \"float elevation\" 30 " + params, "t", silent_log());
    std::string bands = "bands,wavelengths=";
    for (size_t i = 0; i < model.nm.size(); ++i) bands += fmt::format("{}{}", i ? "," : "", model.nm[i]);
    set_wavelengths(d, bands);
    ThreadPool pool(1);
    const Scene scene(d, make_registry(builtin_materials(), builtin_integrators()), pool, log);
    const EnvironmentLight& light = *scene.environment()[0];
    std::vector<double> sun(model.nm.size()), sky(model.nm.size());
    for (size_t i = 0; i < model.nm.size(); ++i) {
      SampledWavelengths lambda;
      lambda.count = 1, lambda.nm[0] = float(model.nm[i]), lambda.pdf[0] = 1, lambda.active[0] = true;
      sky[i] = sky_irradiance(light, lambda);
      if (light.sun()) sun[i] = sun_irradiance(light, lambda);
    }
    direct = integral(model.nm, sun), diffuse = integral(model.nm, sky);
    std::vector<double> nm, par;
    for (size_t i = 0; i < model.nm.size(); ++i)
      if (model.nm[i] >= 400 && model.nm[i] <= 700) nm.push_back(model.nm[i]), par.push_back(sky[i]);
    diffuse_par = integral(nm, par);
  }

 private:
  /// Of the sky without the sun's disc, by midpoints in cosine squared and azimuth.
  static double sky_irradiance(const EnvironmentLight& light, const SampledWavelengths& lambda) {
    constexpr int kRings = 96, kSectors = 96;
    double sum = 0;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kSectors; ++j) {
        const double z = std::sqrt((i + 0.5) / kRings), r = std::sqrt(1 - z * z),
                     phi = 2 * std::numbers::pi * (j + 0.5) / kSectors;
        sum += double(light.radiance({}, to_float(Vec3d{r * std::cos(phi), r * std::sin(phi), z}), lambda)[0]);
      }
    return std::numbers::pi * sum / (kRings * kSectors);
  }
  /// Of the disc: its radiance above that of the sky beside it.
  static double sun_irradiance(const EnvironmentLight& light, const SampledWavelengths& lambda) {
    const Vec3 sun = *light.sun();
    const double radius = 0.2666 * std::numbers::pi / 180 * std::sqrt(sun_distance_factor(172));
    const Frame frame = Frame::around(sun);
    const auto at = [&](double angle) {
      return double(
          light.radiance({}, frame.to_world(to_float(Vec3d{std::sin(angle), 0, std::cos(angle)})), lambda)[0]);
    };
    return (at(0) - at(1.01 * radius)) * std::numbers::pi * std::pow(std::sin(radius), 2) * kSine;
  }
};

std::string global(double value) { return fmt::format("\"float globalirradiance\" {} ", value); }
std::string diffuse(double value) { return fmt::format("\"float diffuseirradiance\" {} ", value); }
std::string direct(double value) { return fmt::format("\"float directnormalirradiance\" {} ", value); }

void expect_energy(const std::string& params, double direct, double diffuse) {
  const Energy e(params);
  EXPECT_NEAR(e.direct, direct, 0.005 * direct + 1e-9) << params;
  EXPECT_NEAR(e.diffuse, diffuse, 0.005 * diffuse) << params;
  EXPECT_THAT(e.warnings, IsEmpty()) << params;
}

TEST(Station, DirectAndDiffuseEnergyAreTheMeasuredOnes) {
  expect_energy(global(450) + diffuse(120), 330, 120);
  expect_energy(global(450) + direct(660), 330, 120);
  expect_energy(diffuse(120) + direct(660), 330, 120);
  expect_energy(global(450) + diffuse(120) + direct(660), 330, 120);
  expect_energy(global(200) + diffuse(200), 0, 200);
  expect_energy("\"string sky\" \"overcast\" " + global(150), 0, 150);
  expect_energy("\"float scale\" 2 " + global(450) + diffuse(120), 660, 240);
}

TEST(Station, OneValueAloneKeepsTheSplitOfTheClearSky) {
  const Energy clear("");
  const double factor = 300 / (clear.direct + clear.diffuse);
  expect_energy(global(300), clear.direct * factor, clear.diffuse * factor);
  expect_energy(diffuse(clear.diffuse / 2), clear.direct / 2, clear.diffuse / 2);
  expect_energy(direct(clear.direct), clear.direct * kSine, clear.diffuse * kSine);
}

/// Light of clouds is whiter than the blue sky.
TEST(Station, DiffuseLightBeyondTheClearSkysHasTheSpectrumOfTheOvercastSky) {
  const Energy clear(""), overcast("\"string sky\" \"overcast\"");
  const Energy hazy(global(300) + diffuse(clear.diffuse / 2)), cloudy(global(300) + diffuse(300));
  EXPECT_NEAR(hazy.diffuse_par / hazy.diffuse, clear.diffuse_par / clear.diffuse, 1e-4);
  const double expected = clear.diffuse_par + (300 - clear.diffuse) * overcast.diffuse_par / overcast.diffuse;
  EXPECT_NEAR(cloudy.diffuse_par, expected, 1e-3 * expected);
}

TEST(Station, NoiseOfTheInstrumentsIsNoError) {
  const Energy e(global(100) + diffuse(103));
  EXPECT_EQ(e.direct, 0);
  EXPECT_NEAR(e.diffuse, 103, 0.5);
}

TEST(Station, ASunBrighterThanOutsideTheAtmosphereIsLimitedWithAWarning) {
  const Energy e(global(900) + diffuse(100));  // 1600 W/m^2 on a plane that faces the sun
  EXPECT_THAT(e.warnings, Contains(HasSubstr("the sun's direct normal irradiance would be 1600 W/m^2, above the 131")));
  EXPECT_NEAR(e.direct + e.diffuse, 900, 4.5);
  EXPECT_LT(e.direct, 670);
}

TEST(Station, ValuesThatContradictEachOtherAreErrorsWithTheirPosition) {
  const auto error = [](const std::string& params) { return error_of([&] { Energy e(params); }); };
  EXPECT_THAT(
      error(global(450) + diffuse(120) + direct(800)),
      HasSubstr("t:2:65: \"globalirradiance\" 450 is not \"diffuseirradiance\" 120 plus "
                "\"directnormalirradiance\" 800 times the sine of the sun's elevation, 0.5, which is 520 W/m^2"));
  EXPECT_THAT(error(global(100) + diffuse(120)), HasSubstr("more than \"globalirradiance\" 100"));
  EXPECT_THAT(error(global(100) + direct(300)), HasSubstr("more than \"globalirradiance\" 100"));
  EXPECT_THAT(error("\"string sky\" \"overcast\" " + global(300) + diffuse(100)), HasSubstr("this sky has no sun"));
  EXPECT_THAT(error("\"string sky\" \"overcast\" " + direct(300)), HasSubstr("no such light"));
  EXPECT_THAT(error("\"float illuminance\" 3 " + global(300)), HasSubstr("exclude each other"));
  EXPECT_THAT(error(global(-1)), HasSubstr("outside its range"));
}

/// pvlib 0.16.1, get_solarposition: apparent_elevation, azimuth. The first is the example of SPA (NREL/TP-560-34302).
TEST(SunPosition, AgreesWithSpa) {
  struct Case {
    const char* time;
    double latitude, longitude, elevation, azimuth;
  };
  for (const Case& c : {Case{"2003-10-17T12:30:30-07:00", 39.742476, -105.1786, 39.8922, 194.3402},
                        Case{"2026-06-21 11:00+0200", 47.38, 8.54, 52.1466, 116.1500},
                        Case{"2026-12-21T06:00:00.0Z", -33, 151, 35.7260, 263.2651}}) {
    const auto time = parse_time(c.time);
    ASSERT_TRUE(time && time->offset_seconds) << c.time;
    const SunPosition sun =
        sun_position(time->days_since_2000() - *time->offset_seconds / 86400, c.latitude, c.longitude);
    EXPECT_NEAR(sun.elevation, c.elevation, 0.01) << c.time;
    EXPECT_NEAR(sun.azimuth, c.azimuth, 0.01) << c.time;
  }
}

TEST(SunPosition, OtherTextIsNoTime) {
  for (const char* text : {"", "noon", "2026-13-01T00:00Z", "2026-02-29", "2026-06-21T25:00", "2026-06-21T11:60",
                           "2026-06-21T11:00+2", "2026-06-21T11:00 MEZ", "21.6.2026 11:00"})
    EXPECT_FALSE(parse_time(text)) << text;
  EXPECT_FALSE(parse_time("2026-06-21T11:00")->offset_seconds);
  EXPECT_EQ(parse_time("2026-06-21T11:00-03:30")->offset_seconds, -12600);
  EXPECT_EQ(parse_time("2024-12-31")->day_of_year(), 366);
}

}  // namespace
}  // namespace frond
