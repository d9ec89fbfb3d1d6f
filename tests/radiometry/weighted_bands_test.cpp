// Bands with responses: shares of brf and flux against the integrals that define them, under lights with and without
// lines.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "radiometry/brf.h"
#include "radiometry/flux.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/photons.h"
#include "scene/format/parser.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Each comparison allows 4.5 standard errors: a false alarm of 7e-6 each, below 1e-3 for all of this file.
constexpr double kZ = 4.5;

/// Function of wavelength that is linear between points and 0 beyond.
struct Line {
  std::vector<std::pair<double, double>> points;
  double operator()(double nm) const {
    for (size_t i = 1; i < points.size(); ++i)
      if (nm >= points[i - 1].first && nm <= points[i].first)
        return std::lerp(points[i - 1].second, points[i].second,
                         (nm - points[i - 1].first) / (points[i].first - points[i - 1].first));
    return 0;
  }
  std::string text() const {
    std::string text;
    for (const auto& [nm, value] : points) text += fmt::format("{} {}\n", nm, value);
    return text;
  }
};

/// By midpoints of 0.01 nm, of which no line here is narrower than ten.
template <class Function>
double integral(double from, double to, const Function& f) {
  constexpr double kStep = 0.01;
  double sum = 0;
  for (double nm = from + kStep / 2; nm < to; nm += kStep) sum += f(nm) * kStep;
  return sum;
}

/// Reflectance of the plane: a leaf's, roughly.
const Line kLeaf{{{300, 0.05},
                  {500, 0.05},
                  {550, 0.15},
                  {600, 0.08},
                  {680, 0.04},
                  {740, 0.42},
                  {1300, 0.42},
                  {1450, 0.15},
                  {1650, 0.32},
                  {1950, 0.03},
                  {2200, 0.16},
                  {2500, 0.03}}};
const Line kNir{{{700, 1}, {2500, 1}}}, kPar{{{400, 1}, {700, 1}}}, kGreen{{{540, 1}, {560, 1}}},
    kRedEdge{{{690, 0}, {705, 0.7}, {720, 0.3}, {745, 0}}};
/// Lines of 1 nm at half their height, two of them between the nodes of a grid of 10 nm.
const Line kLamp{{{380, 0},
                  {434, 0},
                  {435, 3},
                  {436, 0},
                  {545, 0},
                  {546.1, 2},
                  {547, 0},
                  {611, 0},
                  {612, 5},
                  {613.3, 0},
                  {700, 0},
                  {763, 0},
                  {763.6, 1},
                  {764, 0},
                  {2500, 0}}};

std::string sun(const std::string& spectrum) {
  return "LightSource \"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0] \"spectrum L\" " + spectrum + "\n";
}

class WeightedBands : public ::testing::Test {
 protected:
  WeightedBands() {
    for (const auto& [name, line] : {std::pair{"nir.spd", &kNir},
                                     {"par.spd", &kPar},
                                     {"green.spd", &kGreen},
                                     {"edge.spd", &kRedEdge},
                                     {"lamp.spd", &kLamp},
                                     {"leaf.spd", &kLeaf}})
      folder_.write(name, line->text());
  }
  std::string path(const std::string& name) const { return folder_.name_of(name); }
  std::string bands(const std::vector<std::string>& names) const {
    std::string text = "bands,responses=";
    for (const std::string& name : names) text += (&name == &names.front() ? "" : ",") + path(name + ".spd");
    return text;
  }
  /// A plane of kLeaf, as an instance of an object, repeated periodically.
  SceneDescription plane(const std::string& light) const {
    return parse_scene(
        folder_.write("scene.pbrt",
                      "Option \"float period\" [1 1]\nWorldBegin\n" + light +
                          "MakeNamedMaterial \"leaf\" \"string type\" \"diffuse\" \"spectrum reflectance\" \"" +
                          path("leaf.spd") +
                          "\"\nNamedMaterial \"leaf\"\nObjectBegin \"plane\"\n"
                          "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n"
                          "ObjectEnd\nObjectInstance \"plane\"\n"),
        silent_log());
  }
  FluxMeasurement flux(const std::string& light, const FluxRequest& request, uint64_t paths = 100000) const {
    Session session(silent_log(), {2, {}, {}});
    FluxMeter meter(session, plane(light), request);
    meter.trace(paths, session.pool());
    return meter.read();
  }
  BrfMeasurement brf(const std::string& light, const std::string& wavelengths, uint64_t samples = 128) const {
    Session session(silent_log(), {2, {}, {}});
    const BrfMeter meter(session, plane(light), {.views = {{0, 0}}, .wavelengths = wavelengths});
    RenderPart part = meter.scene().empty_part();
    session.render(meter.scene(), {0, samples}, part);
    return meter.read(part.film);
  }
  TestFolder folder_{"weighted_bands"};
};

/// The definition: the share of a response's light, integral of R E s over integral of R E.
template <class Light>
double share(const Line& response, const Light& light) {
  const double from = response.points.front().first, to = response.points.back().first;
  return integral(from, to, [&](double nm) { return response(nm) * light(nm) * kLeaf(nm); }) /
         integral(from, to, [&](double nm) { return response(nm) * light(nm); });
}

TEST_F(WeightedBands, AreTheSharesOfResponseTimesTheScenesLightInBrfAndFlux) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {});
  const auto of_sun = [&](double nm) { return double(solar->at(float(nm))); };
  struct Case {
    std::string light;
    std::function<double(double)> spectrum;
    std::vector<std::string> names;
    std::vector<const Line*> responses;
  };
  const std::vector<Case> cases{
      {sun("\"solar-am1.5-global\""), of_sun, {"nir", "par", "green", "edge"}, {&kNir, &kPar, &kGreen, &kRedEdge}},
      {sun("\"" + path("lamp.spd") + "\""), kLamp, {"nir", "par"}, {&kNir, &kPar}},
      {"LightSource \"infinite\" \"spectrum L\" \"" + path("lamp.spd") + "\"\n", kLamp, {"par"}, {&kPar}}};
  for (const Case& c : cases) {
    const FluxMeasurement sent = flux(c.light, {.wavelengths = bands(c.names), .organs = OrganKind::instance});
    const BrfMeasurement seen = brf(c.light, bands(c.names));
    ASSERT_EQ(sent.bands.size(), c.names.size());
    for (size_t b = 0; b < c.names.size(); ++b) {
      SCOPED_TRACE(c.light + c.names[b]);
      EXPECT_EQ(sent.bands[b].name, c.names[b]);
      EXPECT_EQ(seen.bands[b].name, c.names[b]);
      const double expected = share(*c.responses[b], c.spectrum);
      const MeanError &reflected = sent.reflected[b], &absorbed = sent.materials[0].absorbed[b];
      EXPECT_NEAR(reflected.mean, expected, kZ * reflected.standard_error + 2e-4);
      EXPECT_NEAR(absorbed.mean, 1 - expected, kZ * absorbed.standard_error + 2e-4);
      EXPECT_LT(reflected.standard_error, 1e-3) << "the test has lost its power";
      // Every path carries one unit of the band's light; of an extended light up to the sum over its directions.
      EXPECT_NEAR(sent.sum[b].mean, 1, 2e-4);
      EXPECT_NEAR(sent.materials[0].uncollided[b].mean, 1, 2e-4);
      EXPECT_NEAR(sent.by_organ[b].mean, absorbed.mean, 1e-6);
      EXPECT_NEAR(seen.at(0, b).mean, expected, kZ * seen.at(0, b).standard_error + 1e-4);
    }
  }
}

/// 0.3768 is the mean under the sun, 0.2613 under the response alone.
TEST_F(WeightedBands, TheLightChangesTheAlbedoOfTheNearInfrared) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {});
  const double lit = share(kNir, [&](double nm) { return double(solar->at(float(nm))); }),
               flat = share(kNir, [](double) { return 1.0; });
  EXPECT_GT(lit, 1.3 * flat) << "the test has lost its power";
}

TEST_F(WeightedBands, TakeTheIrradianceThatIsNamed) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {}), lamp = read_spd(path("lamp.spd"), {});
  const auto of_sun = [&](double nm) { return double(solar->at(float(nm))); };
  const std::string both = bands({"par", "nir"});
  const FluxMeasurement under_sun =
      flux(sun("\"stdillum-E\""), {.wavelengths = both, .irradiance = solar, .irradiance_name = "solar-am1.5-global"});
  const FluxMeasurement under_lamp =
      flux(sun("\"solar-am1.5-global\""), {.wavelengths = both, .irradiance = lamp, .irradiance_name = "lamp"});
  for (size_t b = 0; b < 2; ++b) {
    const Line& response = b == 0 ? kPar : kNir;
    EXPECT_NEAR(under_sun.reflected[b].mean, share(response, of_sun),
                kZ * under_sun.reflected[b].standard_error + 1e-5);
    EXPECT_NEAR(under_lamp.reflected[b].mean, share(response, kLamp),
                kZ * under_lamp.reflected[b].standard_error + 1e-5);
    EXPECT_NEAR(under_lamp.sum[b].mean, 1, 1e-4);
  }
}

/// Of 256 measurements, z has the mean 0 and the variance 1. Both are tested at 4.5 standard errors.
TEST_F(WeightedBands, HaveHonestStandardErrors) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {});
  const double expected = share(kNir, [&](double nm) { return double(solar->at(float(nm))); });
  constexpr int kRuns = 256;
  constexpr uint64_t kPaths = 1024;
  Session session(silent_log(), {2, {}, {}});
  FluxMeter meter(session, plane(sun("\"solar-am1.5-global\"")), {.wavelengths = bands({"nir"})});
  double sum = 0, squares = 0, before = 0;
  double error = 0;
  for (int run = 0; run < kRuns; ++run) {
    meter.trace(kPaths, session.pool());
    const FluxMeasurement all = meter.read();
    const double total = all.reflected[0].mean * double(all.paths), mean = (total - before) / kPaths;
    before = total;
    error = all.reflected[0].standard_error * std::sqrt(double(all.paths) / kPaths);
    sum += mean - expected, squares += (mean - expected) * (mean - expected);
  }
  EXPECT_NEAR(sum / kRuns / error, 0, kZ / std::sqrt(double(kRuns)));
  EXPECT_NEAR(squares / kRuns / (error * error), 1, kZ * std::sqrt(2.0 / kRuns));
}

TEST_F(WeightedBands, NeedLight) {
  const SpectrumPtr lamp = read_spd(path("lamp.spd"), {}), solar = named_spectrum("solar-am1.5-global", {});
  folder_.write("dark.spd", "640 0  650 1  660 0");
  EXPECT_THAT(error_of([&] { flux(sun("\"" + path("lamp.spd") + "\""), {.wavelengths = bands({"dark"})}, 1); }),
              HasSubstr("no light falls on the scene from above, from +z, in band dark"));
  EXPECT_THAT(error_of([&] {
                flux(sun("\"" + path("lamp.spd") + "\""), {.wavelengths = bands({"par"}), .irradiance = solar}, 1);
              }),
              HasSubstr("give no light at 400."));
  EXPECT_THAT(
      error_of([&] { flux(sun("\"solar-am1.5-global\""), {.wavelengths = bands({"dark"}), .irradiance = lamp}, 1); }),
      HasSubstr("the irradiance is 0 in band dark"));
  folder_.write("short.spd", "380 1  800 1");
  EXPECT_THAT(error_of([&] {
                flux(sun("\"solar-am1.5-global\""),
                     {.wavelengths = bands({"nir"}), .irradiance = read_spd(path("short.spd"), {})}, 1);
              }),
              HasSubstr("the irradiance is known from 380 to 800 nm, band nir needs 700 to 2500 nm"));
  // Both reject a light whose table ends inside a response: it does not define the light beyond.
  const std::string d65 = sun("\"stdillum-D65\"");
  EXPECT_THAT(error_of([&] { flux(d65, {.wavelengths = bands({"nir"})}, 1); }), HasSubstr("known from 360 to 830 nm"));
  EXPECT_THAT(error_of([&] { brf(d65, bands({"nir"})); }), HasSubstr("known from 360 to 830 nm"));
}

std::vector<Band> bands_at(double step, double first = 400, double last = 700) {
  std::vector<Band> bands;
  for (double nm = first; nm <= last + 1e-9; nm += step) bands.push_back({nm});
  return bands;
}

/// Independent of PhotonWeights: the integral of E lambda over N_A h c.
template <class Light>
double photons(const Light& light) {
  return integral(400, 700, [&](double nm) { return light(nm) * nm; }) / 119.626565817;
}

TEST(Photons, AreTheIntegralOfTheIrradianceAtAnyStepOfTheBands) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {});
  const auto of_sun = [&](double nm) { return double(solar->at(float(nm))); };
  std::vector<SpectrumPoint> points;
  for (const auto& [nm, value] : kLamp.points) points.push_back({nm, value});
  const TabulatedSpectrum lamp(points);
  EXPECT_NEAR(photons(of_sun), 1977.9, 0.2);
  for (const double step : {1., 10., 20., 25., 50.}) {
    EXPECT_NEAR(PhotonWeights::from_irradiance(bands_at(step), *solar)->incident, photons(of_sun),
                1e-5 * photons(of_sun))
        << step;
    EXPECT_NEAR(PhotonWeights::from_irradiance(bands_at(step), lamp)->incident, photons(kLamp), 1e-4 * photons(kLamp))
        << step;
  }
  // Bands may begin and end 10 nm inside, or reach beyond.
  EXPECT_NEAR(PhotonWeights::from_irradiance(bands_at(20, 410, 690), *solar)->incident, photons(of_sun), 0.02);
  EXPECT_NEAR(PhotonWeights::from_irradiance(bands_at(20, 390, 710), *solar)->incident, photons(of_sun), 0.02);
}

/// Shares that are linear in wavelength are interpolated without an error, whatever the lines of the lamp.
TEST(Photons, WeightSharesAsLinearBetweenTheBands) {
  std::vector<SpectrumPoint> points;
  for (const auto& [nm, value] : kLamp.points) points.push_back({nm, value});
  const TabulatedSpectrum lamp(points);
  const auto share_at = [](double nm) { return 0.1 + 0.002 * (nm - 400); };
  const double expected = integral(400, 700, [&](double nm) { return kLamp(nm) * nm * share_at(nm); }) /
                          integral(400, 700, [&](double nm) { return kLamp(nm) * nm; });
  for (const double step : {1., 20., 50.}) {
    std::vector<Band> bands = bands_at(step);
    std::ranges::reverse(bands);  // in any order
    const auto weights = PhotonWeights::from_irradiance(bands, lamp)->weights;
    double mean = 0, sum = 0;
    for (size_t b = 0; b < bands.size(); ++b) mean += weights[b] * share_at(bands[b].nm), sum += weights[b];
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(mean, expected, 1e-5) << step;
  }
}

TEST(Photons, NeedBandsAndLightFrom400To700) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {});
  EXPECT_FALSE(PhotonWeights::from_irradiance(bands_at(60), *solar));
  EXPECT_FALSE(PhotonWeights::from_irradiance(bands_at(20, 420, 700), *solar));
  EXPECT_FALSE(PhotonWeights::from_irradiance(std::vector<Band>{{550, {{400, 1}, {700, 1}}, "par"}}, *solar));
  const std::vector<SpectrumPoint> blue{{400, 1}, {500, 1}}, ending{{400, 1}, {500, 1}, {501, 0}};
  EXPECT_THAT(error_of([&] { PhotonWeights::from_irradiance(bands_at(20), TabulatedSpectrum(blue)); }),
              HasSubstr("known from 400 to 500 nm, photons need 400 to 700 nm"));
  EXPECT_GT(PhotonWeights::from_irradiance(bands_at(20), TabulatedSpectrum(ending))->incident, 0);
}

/// The light of the scene is integrated over its own points too.
TEST_F(WeightedBands, TheScenesIrradianceHasTheLinesOfItsLamps) {
  Session session(silent_log(), {1, {}, {}});
  SceneDescription d =
      plane(sun("\"" + path("lamp.spd") + "\"") + "LightSource \"infinite\" \"spectrum L\" [300 1 2500 1]\n");
  d.options.push_back({"string", "wavelengths", {}, {}, std::vector<std::string>{"bands,wavelengths=550"}});
  const LoadedScene loaded = session.load(std::move(d));
  const SpectrumPtr e = horizontal_irradiance(loaded.scene(), {400, 700}, ThreadPool(2));
  const double base = double(e->at(500)), line = double(e->at(612)) - base;
  const auto expected = [&](double nm) { return base + kLamp(nm) / 5 * line; };
  for (const double nm : {434.5, 435.0, 546.1, 612.3})
    EXPECT_NEAR(double(e->at(float(nm))), expected(nm), 1e-4 * line) << nm;
}

}  // namespace
}  // namespace frond
