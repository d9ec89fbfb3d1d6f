// The light "sky": its angular distributions, irradiances and samples.

#include <gmock/gmock.h>

#include <numbers>

#include "core/log.h"
#include "core/math/random.h"
#include "integrators/registry.h"
#include "lights/sky_shape.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "spectra/cie.h"
#include "spectra/csv_columns.h"
#include "spectra/spectrl2.h"
#include "system/file_bytes.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kRadians = std::numbers::pi / 180;
constexpr const char* kBands = "bands,wavelengths=400,550,1100,2000";
constexpr double kSunRadius = 0.2666 * kRadians;

/// A sky in the text of a test, and its log.
struct Sky {
  explicit Sky(const std::string& params, const std::string& transform = "") {
    class Keep final : public Log {
     public:
      explicit Keep(Sky& sky) : sky_(sky) {}
      void info(std::string_view message) const override { sky_.messages.emplace_back(message); }
      void warn(const Location&, std::string_view message) const override { sky_.warnings.emplace_back(message); }

     private:
      Sky& sky_;
    };
    const Keep log(*this);
    SceneDescription d = parse_scene_text("WorldBegin\n" + transform + "LightSource \"sky\" " + params, "t", log);
    ThreadPool pool(1);
    set_wavelengths(d, kBands);
    scene.emplace(d, make_registry(builtin_materials(), builtin_integrators()), pool, log);
  }
  const EnvironmentLight& light() const { return *scene->environment()[0]; }
  SampledWavelengths lambda() const { return scene->wavelengths().sample(0.5f); }
  SampledSpectrum radiance(const Vec3& direction) const { return light().radiance({}, direction, lambda()); }

  std::vector<std::string> warnings, messages;
  std::optional<Scene> scene;
};

Vec3 direction(double zenith, double azimuth) {
  return to_float(Vec3d{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)});
}

/// Integral of a function of the direction over the upper hemisphere, by midpoints in cosine and azimuth.
template <class F>
double over_hemisphere(const F& f, int rings = 400, int sectors = 360) {
  double sum = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j)
      sum += f(direction(std::acos((i + 0.5) / rings), 2 * std::numbers::pi * (j + 0.5) / sectors));
  return sum * 2 * std::numbers::pi / (rings * sectors);
}

double relative(const SkyShape& shape, const Vec3& d, const Vec3& sun) {
  return double(shape.radiance(d.z, 2 * std::asin(std::min(1.f, length(d - sun) / 2))));
}

/// Compares a shape, over its irradiance, with a reference at one direction.
void expect_radiance(const SkyShape& shape, double sun_zenith, double zenith, double azimuth, double expected) {
  const Vec3 sun = direction(sun_zenith, 0);
  const double irradiance = over_hemisphere([&](const Vec3& d) { return relative(shape, d, sun) * double(d.z); });
  EXPECT_NEAR(relative(shape, direction(zenith, azimuth), sun) / irradiance, expected, 2e-4 * expected);
}

TEST(SkyShape, PerezAgreesWithTheReference) {
  const auto t = csv_columns(read_file_bytes(FROND_SOURCE_DIR "/tests/reference/sky_perez.csv", {}));
  ASSERT_EQ(t[0].size(), 60u);
  for (size_t i = 0; i < t[0].size(); ++i)
    expect_radiance(perez_sky(t[0][i], t[1][i], t[2][i]), t[0][i] * kRadians, t[3][i] * kRadians, t[4][i] * kRadians,
                    t[5][i]);
}

TEST(SkyShape, CieAgreesWithTheReference) {
  const auto t = csv_columns(read_file_bytes(FROND_SOURCE_DIR "/tests/reference/sky_cie.csv", {}));
  ASSERT_EQ(t[0].size(), 60u);
  for (size_t i = 0; i < t[0].size(); ++i)
    expect_radiance(cie_sky(int(t[0][i])), t[1][i] * kRadians, t[2][i] * kRadians, t[3][i] * kRadians, t[4][i]);
}

TEST(SkyLight, RadianceTimesCosineIntegratesToTheDiffuseIrradiance) {
  const std::vector<std::pair<std::string, Atmosphere>> skies{
      {"", {}},
      {"\"float elevation\" 10 \"float aerosol\" 0.4", {.sun_zenith_deg = 80, .aerosol = 0.4}},
      {"\"float elevation\" 90 \"integer cietype\" 12", {.sun_zenith_deg = 0}}};
  for (const auto& [params, atmosphere] : skies) {
    const Sky sky(params);
    const ClearSkyIrradiance e = spectrl2(atmosphere);
    const Vec3 sun = *sky.light().sun();
    for (int lane = 0; lane < 4; ++lane) {
      const double sum = over_hemisphere([&](const Vec3& d) {
        return std::acos(double(dot(d, sun))) < 2 * kSunRadius ? 0 : double(sky.radiance(d)[lane] * d.z);
      });
      const size_t i = size_t(std::ranges::find(e.nm, double(sky.lambda().nm[size_t(lane)])) - e.nm.begin());
      if (i == e.nm.size()) continue;  // 1100 nm is no wavelength of the table
      EXPECT_NEAR(sum, e.diffuse[i], 2e-3 * e.diffuse[i]) << params << lane;
    }
  }
}

TEST(SkyLight, TheSunsDiscHasTheDirectIrradianceAndItsTrueSize) {
  const Sky sky("\"float elevation\" 40 \"float azimuth\" 30 \"integer day\" 1");
  const ClearSkyIrradiance e = spectrl2({.sun_zenith_deg = 50, .day = 1});
  const Vec3 sun = direction(50 * kRadians, 30 * kRadians);
  EXPECT_LT(length(*sky.light().sun() - sun), 1e-6f);
  const double radius = kSunRadius * std::sqrt(sun_distance_factor(1));
  const Frame frame = Frame::around(sun);
  const auto at = [&](double angle) {
    return sky.radiance(frame.to_world(to_float(Vec3d{std::sin(angle), 0, std::cos(angle)})))[1];
  };
  EXPECT_GT(at(0.999 * radius), 100 * at(1.001 * radius));
  EXPECT_NEAR(at(0.5 * radius), at(0), 1e-5f * at(0));
  const auto i = size_t(std::ranges::find(e.nm, 550) - e.nm.begin());
  EXPECT_NEAR((double(at(0)) - double(at(1.001 * radius))) * std::numbers::pi * std::pow(std::sin(radius), 2),
              e.direct_normal[i], 1e-4 * e.direct_normal[i]);
}

/// Compares the numbers of samples in bins of the sphere with the integrals of the density: chi-square over 8 x 8 bins
/// and the disc. The bound of 142 is exceeded with probability 1e-7.
template <class Sample, class Pdf>
void expect_density(const Sky& sky, const Sample& sample, const Pdf& pdf) {
  constexpr int kBins = 8, kSamples = 200000;
  const Vec3 sun = *sky.light().sun();
  const auto bin = [&](const Vec3& d) {
    if (length(d - sun) < float(kSunRadius)) return kBins * kBins;
    const double turn = std::atan2(double(d.y), double(d.x)) / (2 * std::numbers::pi) + 0.5;
    return int(double(d.z) * kBins) * kBins + std::min(int(turn * kBins), kBins - 1);
  };
  std::vector<double> expected(kBins * kBins + 1), found(kBins * kBins + 1);
  over_hemisphere(
      [&](const Vec3& d) {
        if (bin(d) < kBins * kBins) expected[size_t(bin(d))] += double(pdf(d)) * 2 * std::numbers::pi / 4e6;
        return 0;
      },
      2000, 2000);
  expected.back() = double(pdf(sun)) * 2 * std::numbers::pi * (1 - std::cos(kSunRadius));
  double sum = 0;
  for (const double share : expected) sum += share;
  EXPECT_NEAR(sum, 1, 2e-3);
  RandomStream random(7);
  int others = 0;  // directions that rounding puts into a neighbouring cell
  for (int i = 0; i < kSamples; ++i) {
    const auto s = sample(Vec2{random.uniform(), random.uniform()});
    if (!s) continue;  // below the horizon, by rounding
    if (std::abs(s->pdf - pdf(s->wi)) > 1e-4f * s->pdf) ++others;
    EXPECT_GT(s->wi.z, 0);
    ++found[size_t(bin(s->wi))];
  }
  EXPECT_LT(others, 20);
  double chi2 = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    const double n = expected[i] * kSamples;
    if (n > 5)
      chi2 += (found[i] - n) * (found[i] - n) / n;
    else
      EXPECT_LT(found[i], 30);
  }
  EXPECT_LT(chi2, 142);
}

TEST(SkyLight, SamplesFollowTheDensityWhichIntegratesToOne) {
  // The day on which the sun is at its mean distance: the disc's bin then has the mean radius.
  const Sky sky("\"float elevation\" 35 \"float azimuth\" 250 \"integer day\" 94");
  const EnvironmentLight& light = sky.light();
  const SampledWavelengths lambda = sky.lambda();
  expect_density(
      sky, [&](Vec2 u) { return light.sample({}, u, lambda); }, [&](const Vec3& d) { return light.pdf({}, d); });
  expect_density(
      sky, [&](Vec2 u) { return light.sample_compensated({}, u, lambda); },
      [&](const Vec3& d) { return light.compensated_pdf({}, d); });
}

TEST(SkyLight, IsNeverNegativeAndAlwaysFinite) {
  for (int elevation = -10; elevation <= 90; elevation += elevation < 3 ? 1 : 29)
    for (const double aerosol : {0.0, 0.1, 1.0, 10.0})
      for (const double angstrom : {-1.0, 1.14, 4.0}) {
        const Sky sky(fmt::format("\"float elevation\" {} \"float aerosol\" {} \"float angstrom\" {}",
                                  double(elevation) + (elevation == 1 ? -0.99 : 0), aerosol, angstrom));
        const EnvironmentLight& light = sky.light();
        EXPECT_TRUE(light.power(1) >= 0 && std::isfinite(light.power(1)));
        const double sum = over_hemisphere(
            [&](const Vec3& d) {
              EXPECT_TRUE(sky.radiance(d).is_physical()) << elevation << ' ' << aerosol << ' ' << angstrom;
              const float pdf = light.pdf({}, d), competing = light.compensated_pdf({}, d);
              EXPECT_TRUE(pdf >= 0 && std::isfinite(pdf) && competing >= 0 && std::isfinite(competing));
              return double(sky.radiance(d)[2]);
            },
            40, 40);
        if (aerosol < 10) {
          EXPECT_EQ(sum > 0, elevation > 0) << elevation << ' ' << aerosol << ' ' << angstrom;
        }
        EXPECT_TRUE(sky.radiance({0, 0, -1}).is_black());
      }
}

TEST(SkyLight, IsBlackAtNightWithAWarning) {
  const Sky sky("\"float elevation\" -5");
  EXPECT_THAT(sky.warnings, Contains(HasSubstr("the sun is not above the horizon")));
  EXPECT_FALSE(sky.light().sun());
  EXPECT_EQ(sky.light().power(1), 0);
  EXPECT_FALSE(sky.light().sample({}, {0.3f, 0.3f}, sky.lambda()));
}

TEST(SkyLight, AnOvercastSkyIsAQuarterOfTheClearDayWithoutSun) {
  const Sky sky("\"string sky\" \"overcast\"");
  const ClearSkyIrradiance e = spectrl2({});
  EXPECT_FALSE(sky.light().sun());
  const auto i = size_t(std::ranges::find(e.nm, 550) - e.nm.begin());
  const double clear = e.direct_normal[i] * std::cos(30 * kRadians) + e.diffuse[i];
  EXPECT_NEAR(over_hemisphere([&](const Vec3& d) { return double(sky.radiance(d)[1] * d.z); }), clear / 4,
              1e-3 * clear);
  // Type 1: the zenith is 3 times as bright as the horizon, to within the standard's rounding.
  EXPECT_NEAR(double(sky.radiance({0, 0, 1})[1] / sky.radiance(direction(89.9 * kRadians, 0))[1]), 3, 0.03);
}

TEST(SkyLight, BelowTheHorizonIsALambertianGroundOfTheAlbedo) {
  const Sky sky("\"float albedo\" 0.4 \"float scale\" 2");
  const ClearSkyIrradiance e = spectrl2({.albedo = 0.4});
  const auto i = size_t(std::ranges::find(e.nm, 550) - e.nm.begin());
  const double expected = 2 * 0.4 / std::numbers::pi * (e.direct_normal[i] * std::cos(30 * kRadians) + e.diffuse[i]);
  for (const Vec3& d : {Vec3{0, 0, -1}, Vec3{0.6f, 0, -0.8f}})
    EXPECT_NEAR(double(sky.radiance(d)[1]), expected, 1e-4 * expected);
}

TEST(SkyLight, ItsTransformTurnsIt) {
  const Sky up_is_y("\"float elevation\" 40", "Rotate -90 1 0 0\n"), up_is_z("\"float elevation\" 40");
  for (const Vec3& d : {direction(0.2, 0.3), direction(1.2, 2), direction(50 * kRadians, 0)}) {
    const float expected = up_is_z.radiance(d)[1];
    EXPECT_NEAR(up_is_y.radiance({d.x, d.z, -d.y})[1], expected, 1e-4f * expected);
  }
  EXPECT_TRUE(up_is_y.radiance({0, -1, 0}).is_black());
}

TEST(SkyLight, SunDirectionReplacesTheAngles) {
  const Sky by_direction("\"vector3 sundirection\" [ 0 1 1 ]"),
      by_angles("\"float elevation\" 45 \"float azimuth\" 90");
  EXPECT_LT(length(*by_direction.light().sun() - *by_angles.light().sun()), 1e-6f);
  EXPECT_NEAR(by_direction.light().power(1), by_angles.light().power(1), 1e-5 * by_angles.light().power(1));
}

TEST(SkyLight, LogsItsIrradiances) {
  const ClearSkyIrradiance e = spectrl2({});
  const double direct = integral(e.nm, e.direct_normal) * std::cos(30 * kRadians), diffuse = integral(e.nm, e.diffuse);
  EXPECT_THAT(Sky("").messages, ElementsAre(HasSubstr(fmt::format("total {:.2f}, direct {:.2f}, diffuse {:.2f} W/m^2",
                                                                  direct + diffuse, direct, diffuse))));
  EXPECT_THAT(Sky("\"float illuminance\" 3.14159265").messages, ElementsAre(HasSubstr("has the luminance 1")));
  EXPECT_THAT(Sky("").warnings, IsEmpty());
}

TEST(SkyLight, BadParametersAreErrorsWithTheirPosition) {
  const auto error = [](const std::string& params, const std::string& transform = "") {
    return error_of([&] { Sky(params, transform); });
  };
  EXPECT_THAT(error("\"float elevation\" 91"),
              HasSubstr("t:2:37: \"elevation\" is 91, outside its range -90 to 90 degrees"));
  EXPECT_THAT(error("\"float aerosol\" -0.1"), HasSubstr("t:2:35: \"aerosol\" is -0.1, outside its range 0 to 10"));
  EXPECT_THAT(error("\"string sky\" \"cloudy\""), HasSubstr("t:2:32"));
  EXPECT_THAT(error("\"integer cietype\" 16"), HasSubstr("outside its range 1 to 15"));
  EXPECT_THAT(error("\"float azimuth\" 10 \"vector3 sundirection\" [ 0 0 1 ]"),
              HasSubstr("t:2:35: \"azimuth\" and \"sundirection\" exclude each other"));
  EXPECT_THAT(error("\"vector3 sundirection\" [ 0 0 0 ]"), HasSubstr("it is no direction"));
  EXPECT_THAT(error("", "Scale 1 1 2\n"), HasSubstr("t:3:13: the light's transform is not a rotation"));
  EXPECT_THAT(error("\"float elevation\" -1 \"float illuminance\" 3"), HasSubstr("the light is black"));
}

}  // namespace
}  // namespace frond
