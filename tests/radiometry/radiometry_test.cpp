// Virtual radiometers, against closed forms and against each other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "radiometry/brf.h"
#include "radiometry/brf_comparison.h"
#include "radiometry/flux.h"
#include "radiometry/horizontal_irradiance.h"
#include "scene/format/parser.h"
#include "scene/geometry/instance_writer.h"
#include "scene/geometry/random_canopy.h"
#include "system/file_bytes.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

// Each comparison allows 4.5 standard errors: a false alarm of 7e-6 each, below 1e-3 for all of this file.
constexpr double kZ = 4.5;

const std::string kSun =
    "LightSource \"distant\" \"point3 from\" [-0.5 0 0.8660254] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n";
const std::string kSky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n";

std::string soil(double reflectance, double size = 2) {
  return fmt::format(
      "MakeNamedMaterial \"soil\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 {0} 2500 {0}]\n"
      "NamedMaterial \"soil\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0  {1} 0 0  0 {1} 0  {1} {1} 0]\n",
      reflectance, size);
}

std::string lambertian(double reflectance, double transmittance) {
  return fmt::format(
      "MakeNamedMaterial \"leaf\" \"string type\" \"diffusetransmission\" \"spectrum reflectance\" [300 {0} 2500 {0}] "
      "\"spectrum transmittance\" [300 {1} 2500 {1}]\nNamedMaterial \"leaf\"\n",
      reflectance, transmittance);
}

class Radiometry : public ::testing::Test {
 protected:
  Radiometry() : folder_("radiometry") {}

  SceneDescription description(const std::string& world, const std::string& options = "") const {
    const auto path = folder_.write("scene.pbrt", options + "WorldBegin\n" + world);
    return parse_scene(path, silent_log());
  }
  BrfMeasurement brf(const std::string& world, const BrfRequest& request, uint64_t samples, int threads = 2) const {
    Session session(silent_log(), {threads, {}, {}});
    const BrfMeter meter(session, description(world), request);
    RenderPart part = meter.scene().empty_part();
    session.render(meter.scene(), {0, samples}, part);
    return meter.read(part.film);
  }
  FluxMeasurement flux(const std::string& world, const FluxRequest& request, uint64_t paths, int threads = 2,
                       const std::string& options = "") const {
    Session session(silent_log(), {threads, {}, {}});
    FluxMeter meter(session, description(world, options), request);
    meter.trace(paths, session.pool());
    return meter.read();
  }
  /// Leaves of a canopy of this area index in a plot of 2 x 2 x 1.
  std::string canopy(double lai, const std::string& leaf) const {
    RandomCanopy c{.leaf_area_index = lai, .angles = &leaf_angle_distributions()[0], .scale = 0.04, .size = {2, 2}};
    c.heights = {0.05, 1};
    LeafPlacer placer(c);
    InstanceWriter writer(folder_.name_of("leaves.npy"), c.leaves(), {});
    for (uint64_t i = 0; i < c.leaves(); ++i) writer.add(placer.place({}), {});
    writer.finish();
    return leaf +
           "ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd\n"
           "Shape \"instances\" \"string object\" \"leaf\" \"string filename\" \"leaves.npy\"\n";
  }

  TestFolder folder_;
};

const std::array<double, 2> kPlot{2, 2};

TEST_F(Radiometry, TheIrradianceOfSunAndSkyIsTheClosedForm) {
  Session session(silent_log(), {1, {}, {}});
  const auto irradiance = [&](const std::string& lights) {
    const std::string bands = "Option \"string wavelengths\" \"bands,wavelengths=400,550,700,900,1500\"\n";
    const LoadedScene loaded = session.load(description(lights + soil(0), bands));
    const HorizontalIrradiance e(loaded);
    EXPECT_EQ(e.bands().size(), 5u);
    return e.bands()[1];
  };
  const double one = 1 / 106.856895;  // radiance of stdillum-E of luminance 1
  EXPECT_NEAR(irradiance(kSun), one * 0.8660254, 1e-5 * one);
  EXPECT_NEAR(irradiance(kSky), one * std::numbers::pi, 2e-4 * one);
  EXPECT_NEAR(irradiance(kSun + kSky), one * (std::numbers::pi + 0.8660254), 2e-4 * one);
  EXPECT_THAT(
      error_of([&] { irradiance("LightSource \"point\" \"spectrum I\" \"stdillum-E\" \"point3 from\" [0 0 3]\n"); }),
      HasSubstr("scene.pbrt:3:13: brf needs lights outside the scene"));
  EXPECT_THAT(
      error_of([&] {
        irradiance(
            "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n");
      }),
      HasSubstr("no light falls on the scene from above"));
}

TEST_F(Radiometry, ALambertianPlaneHasItsReflectanceInEveryDirection) {
  for (const std::string& light : {kSun, kSky, kSun + kSky}) {
    const BrfMeasurement measurement = brf(
        light + soil(0.3),
        {.views = {{-60, 0}, {0, 0}, {30, 90}, {80, 10}}, .period = kPlot, .wavelengths = "bands,wavelengths=450,800"},
        64);
    for (size_t view = 0; view < 4; ++view)
      for (size_t band = 0; band < 2; ++band) {
        const MeanError& v = measurement.at(view, band);
        EXPECT_NEAR(v.mean, 0.3, kZ * v.standard_error + 1e-4);  // the sky's irradiance is a sum
        EXPECT_LT(v.standard_error, 0.01);
      }
  }
}

/// The sensor is outside the scene, whatever medium the file's camera is in.
TEST_F(Radiometry, TheMediumOfTheCameraIsNotThatOfTheSensor) {
  const std::string mist =
      "Integrator \"volpath\"\nMakeNamedMedium \"mist\" \"string type\" \"homogeneous\" \"float sigma_a\" 1\n";
  const std::string world =
      kSun + soil(0.3) +
      "MediumInterface \"mist\" \"\" Material \"interface\" Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0.5  1 -1 0.5 "
      " -1 1 0.5  1 1 0.5 ]\n";
  const auto measured = [&](const std::string& camera) {
    Session session(silent_log(), {2, {}, {}});
    const BrfMeter meter(session, description(world, mist + camera),
                         {.views = {{0, 0}, {60, 0}}, .period = kPlot, .wavelengths = "bands,wavelengths=450"});
    RenderPart part = meter.scene().empty_part();
    session.render(meter.scene(), {0, 256}, part);
    return meter.read(part.film);
  };
  const BrfMeasurement outside = measured(""), inside = measured("MediumInterface \"mist\" Camera \"perspective\"\n");
  for (size_t view = 0; view < 2; ++view) {
    EXPECT_GT(outside.at(view, 0).mean, 0);
    EXPECT_NEAR(inside.at(view, 0).mean, outside.at(view, 0).mean,
                kZ * std::hypot(inside.at(view, 0).standard_error, outside.at(view, 0).standard_error));
  }
}

/// Walls that face the sun; from the other side their dark side is visible.
TEST_F(Radiometry, ANegativeZenithLooksFromTheSunsSide) {
  const std::string wall =
      "MakeNamedMaterial \"w\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 1 2500 1] NamedMaterial "
      "\"w\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [1 0 0  1 2 0  1 0 1  1 2 1]\n";
  for (const double azimuth : {0.0, 73.0, 200.0}) {
    const std::string turn = fmt::format("Rotate {} 0 0 1\n", azimuth);
    const BrfMeasurement measurement = brf(
        turn + kSun + wall,
        {.views = {{-60, 0}, {60, 0}}, .target = Target{-3, 3, -3, 3, 1}, .wavelengths = "bands,wavelengths=550"}, 64);
    EXPECT_GT(measurement.at(0, 0).mean, 20 * measurement.at(1, 0).mean) << azimuth;
    EXPECT_GT(measurement.at(0, 0).mean, 0.01);
  }
}

/// Leaves that absorb nothing over such a soil send everything back.
TEST_F(Radiometry, NothingIsLostInThePuristCorner) {
  for (const double lai : {1.0, 2.0, 5.0}) {
    const FluxMeasurement measurement = flux(kSun + soil(1) + canopy(lai, lambertian(0.5, 0.5)),
                                             {.period = kPlot, .wavelengths = "bands,wavelengths=800"}, 20000);
    EXPECT_NEAR(measurement.reflected[0].mean, 1, 3 * measurement.reflected[0].standard_error + 1e-5) << lai;
    EXPECT_LT(measurement.reflected[0].standard_error, 1e-3);
    EXPECT_EQ(measurement.transmitted[0].mean, 0);
  }
}

/// Beer's law for spherical leaf angles: exp(-LAI / (2 cos 30)). That leaves are thrown at random, a fixed number of
/// them, makes a binomial of it: exp(-x) (1 - x^2 / 2n).
TEST_F(Radiometry, WhatReachesTheGroundUncollidedFollowsBeersLaw) {
  for (const double lai : {1.0, 3.0}) {
    const FluxMeasurement measurement = flux(kSun + soil(0) + canopy(lai, lambertian(0, 0)),
                                             {.period = kPlot, .wavelengths = "bands,wavelengths=800"}, 200000);
    const auto ground = std::ranges::find(measurement.materials, "soil", &FluxMeasurement::OfMaterial::name);
    ASSERT_NE(ground, measurement.materials.end());
    const double expected = std::exp(-lai / 2 / std::cos(std::numbers::pi / 6));
    // The leaves are one draw: the shares of gaps of plots so large vary by about 1 %.
    EXPECT_NEAR(ground->uncollided[0].mean, expected, 0.04 * expected) << lai;
    EXPECT_EQ(ground->absorbed[0].mean, ground->uncollided[0].mean);
    EXPECT_NEAR(measurement.sum[0].mean, 1, 1e-5);
  }
}

/// A slab of horizontal leaves so thin that light meets it once: R and T of one layer.
TEST_F(Radiometry, OneLeafOverNothingIsALeaf) {
  const FluxMeasurement measurement =
      flux(kSky + lambertian(0.4, 0.25) + "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 2 0  2 2 0]\n",
           {.period = kPlot, .wavelengths = "bands,wavelengths=500,600,700,800,900"}, 50000);
  for (size_t band = 0; band < 5; ++band) {
    EXPECT_NEAR(measurement.reflected[band].mean, 0.4, kZ * measurement.reflected[band].standard_error + 1e-4);
    EXPECT_NEAR(measurement.transmitted[band].mean, 0.25, kZ * measurement.transmitted[band].standard_error + 1e-4);
    EXPECT_NEAR(measurement.materials[0].absorbed[band].mean, 0.35,
                kZ * measurement.materials[0].absorbed[band].standard_error + 1e-4);
    EXPECT_NEAR(measurement.sum[band].mean, 1, kZ * measurement.sum[band].standard_error + 1e-4);
  }
}

/// Two Lambertian sheets with light between them: the doubling equations, in closed form.
TEST_F(Radiometry, TwoLayersAddUpAsTheDoublingEquationsSay) {
  constexpr double kR = 0.45, kT = 0.4, kSoil = 0.2;
  const FluxMeasurement measurement = flux(
      kSun + lambertian(kR, kT) + "Shape \"bilinearmesh\" \"point3 P\" [0 0 1  2 0 1  0 2 1  2 2 1]\n" + soil(kSoil),
      {.period = kPlot, .wavelengths = "bands,wavelengths=800"}, 200000);
  const double expected = kR + kT * kT * kSoil / (1 - kR * kSoil);
  EXPECT_NEAR(measurement.reflected[0].mean, expected, kZ * measurement.reflected[0].standard_error);
  EXPECT_NEAR(measurement.sum[0].mean, 1, 3 * measurement.sum[0].standard_error + 1e-4);
}

/// The albedo from below the light, and from what a sensor sees in directions that are even in their cosine's square.
TEST_F(Radiometry, TheAlbedoIsTheSameFromTheSunAndFromTheSensor) {
  const std::string world = kSun + soil(0.3) + canopy(2, lambertian(0.45, 0.4));
  BrfRequest request{.views = {}, .period = kPlot, .wavelengths = "bands,wavelengths=800"};
  constexpr int kRings = 8, kAzimuths = 12;
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAzimuths; ++k)
      request.views.push_back(
          {std::asin(std::sqrt((i + 0.5) / kRings)) * 180 / std::numbers::pi, 360.0 * (k + 0.5) / kAzimuths});
  const BrfMeasurement seen = brf(world, request, 4);
  double sum = 0, variance = 0;
  for (const MeanError& v : seen.values) sum += v.mean, variance += v.standard_error * v.standard_error;
  const double albedo = sum / double(seen.values.size()), error = std::sqrt(variance) / double(seen.values.size());
  const MeanError sent = flux(world, {.period = kPlot, .wavelengths = "bands,wavelengths=800"}, 200000).reflected[0];
  // The rings' sum over angles is off by less than 1e-3 for so smooth a function.
  EXPECT_NEAR(albedo, sent.mean, kZ * std::hypot(error, sent.standard_error) + 1e-3);
  EXPECT_LT(std::hypot(error, sent.standard_error), 2e-3) << "the test has lost its power";
}

/// The same for leaves that are not reciprocal: their incident direction is the light's, whichever way paths are
/// traced.
TEST_F(Radiometry, TheAlbedoOfRealLeavesIsTheSameBothWays) {
  const std::string world =
      kSun + soil(0.2) +
      canopy(2, "MakeNamedMaterial \"leaf\" \"string type\" \"leaf_solved\" NamedMaterial \"leaf\"\n");
  BrfRequest request{.views = {}, .period = kPlot, .wavelengths = "bands,wavelengths=550,800"};
  constexpr int kRings = 8, kAzimuths = 12;
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAzimuths; ++k)
      request.views.push_back(
          {std::asin(std::sqrt((i + 0.5) / kRings)) * 180 / std::numbers::pi, 360.0 * (k + 0.5) / kAzimuths});
  const BrfMeasurement seen = brf(world, request, 4);
  const FluxMeasurement sent = flux(world, {.period = kPlot, .wavelengths = "bands,wavelengths=550,800"}, 200000);
  for (size_t band = 0; band < 2; ++band) {
    double sum = 0, variance = 0;
    for (size_t view = 0; view < request.views.size(); ++view)
      sum += seen.at(view, band).mean, variance += std::pow(seen.at(view, band).standard_error, 2);
    const auto n = double(request.views.size());
    EXPECT_NEAR(sum / n, sent.reflected[band].mean,
                kZ * std::hypot(std::sqrt(variance) / n, sent.reflected[band].standard_error) + 1e-3);
    EXPECT_NEAR(sent.sum[band].mean, 1, 3 * sent.sum[band].standard_error + 1e-4);
  }
}

TEST_F(Radiometry, WhatLeavesAbsorbAddsUpToTheWhole) {
  const FluxMeasurement measurement = flux(
      kSun + kSky + soil(0.1) + canopy(1, lambertian(0.3, 0.2)),
      {.period = kPlot, .wavelengths = "bands,wavelengths=450,550,650,750,850", .organs = OrganKind::instance}, 50000);
  const auto leaf = std::ranges::find(measurement.materials, "leaf", &FluxMeasurement::OfMaterial::name);
  ASSERT_NE(leaf, measurement.materials.end());
  for (size_t band = 0; band < 5; ++band) {
    double sum = 0, variance = 0;
    for (size_t i = band; i < measurement.by_organ.size(); i += 5) {
      sum += measurement.by_organ[i].mean;
      variance += std::pow(measurement.by_organ[i].standard_error, 2);
    }
    EXPECT_NEAR(sum, leaf->absorbed[band].mean, 1e-6);
    EXPECT_LT(std::sqrt(variance), 0.01);
  }
}

// For two rays, and for another roulette, an integrator must state them.
TEST_F(Radiometry, FirstHitsScatterOneRayUnlessTheSceneSaysTwo) {
  const std::string world = kSun + canopy(1, lambertian(0.5, 0.44));
  const BrfRequest request{.views = {{30, 0}}, .period = kPlot, .wavelengths = "bands,wavelengths=800"};
  const auto measured = [&](const std::string& rays) {
    Session session(silent_log(), {1, {}, {}});
    const BrfMeter meter(session, description(world, "Integrator \"path\" " + rays + "\n"), request);
    RenderPart part = meter.scene().empty_part();
    session.render(meter.scene(), {0, 16}, part);
    return meter.read(part.film).at(0, 0).mean;
  };
  const double by_default = measured("");
  EXPECT_EQ(by_default, measured("\"integer scatteredrays\" 1"));
  EXPECT_NE(by_default, measured("\"integer scatteredrays\" 2"));
  EXPECT_EQ(by_default, measured("\"float roulette\" 2"));
  EXPECT_NE(by_default, measured("\"float roulette\" 1"));
  // Roulette that only the measurement stated would be named as having no effect.
  ::testing::internal::CaptureStderr();
  const ConsoleLog log(true);
  Session session(log, {1, {}, {}});
  const BrfMeter meter(session, description(world, "Integrator \"path\" \"string termination\" \"attenuation\"\n"),
                       request);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Radiometry, FiguresDoNotDependOnThreads) {
  const std::string world = kSun + kSky + soil(0.1) + canopy(1, lambertian(0.3, 0.2));
  const FluxRequest request{.period = kPlot, .wavelengths = "bands,wavelengths=450,850", .organs = OrganKind::instance};
  const FluxMeasurement one = flux(world, request, 5000, 1), three = flux(world, request, 5000, 3);
  EXPECT_EQ(one.reflected[0].mean, three.reflected[0].mean);
  EXPECT_EQ(one.reflected[1].standard_error, three.reflected[1].standard_error);
  for (size_t i = 0; i < one.by_organ.size(); ++i) {
    EXPECT_EQ(one.by_organ[i].mean, three.by_organ[i].mean);
    EXPECT_EQ(one.by_organ[i].standard_error, three.by_organ[i].standard_error);
  }
  const BrfRequest views{.views = {{10, 0}, {40, 0}}, .period = kPlot, .wavelengths = "bands,wavelengths=450"};
  EXPECT_EQ(brf(world, views, 16, 1).at(1, 0).mean, brf(world, views, 16, 3).at(1, 0).mean);
}

TEST_F(Radiometry, AMeterGoesOnFromItsFileAsIfItHadNotBeenStopped) {
  const std::string world = kSun + kSky + soil(0.1) + canopy(1, lambertian(0.3, 0.2));
  const FluxRequest request{.period = kPlot, .wavelengths = "bands,wavelengths=450,850", .organs = OrganKind::instance};
  const FluxMeasurement whole = flux(world, request, 5120);
  Session session(silent_log(), {2, {}, {}});
  const auto meter = [&](const FluxRequest& r) { return FluxMeter(session, description(world), r); };
  const auto file = folder_.name_of("flux.part");
  FluxMeter first = meter(request);
  first.trace(2048, session.pool());
  write_sums(file, std::vector{first.part()});
  FluxMeter second = meter(request);
  second.add(read_sums(file)[0], file);
  EXPECT_EQ(second.paths(), 2048u);
  second.trace(5120 - 2048, session.pool());
  EXPECT_EQ(second.read().reflected[1].mean, whole.reflected[1].mean);
  EXPECT_EQ(second.read().reflected[1].standard_error, whole.reflected[1].standard_error);
  for (size_t i = 0; i < whole.by_organ.size(); ++i) EXPECT_EQ(second.read().by_organ[i].mean, whole.by_organ[i].mean);

  FluxRequest other = request;
  other.organs = {};
  EXPECT_THAT(error_of([&] { meter(other).add(read_sums(file)[0], file); }),
              HasSubstr("another measurement. command: "));
  const std::string bytes = read_file_bytes(file, {});
  const auto error_of_bytes = [&](std::string_view changed) {
    const auto path = folder_.write("changed.part", std::string(changed));
    return error_of([&] { (void)read_sums(path); });
  };
  for (const size_t size : {size_t(20), bytes.size() / 2, bytes.size() - 1})
    EXPECT_THAT(error_of_bytes(bytes.substr(0, size)), HasSubstr("cut short"));
  std::string damaged = bytes;
  damaged[bytes.size() - 100] ^= 1;
  EXPECT_THAT(error_of_bytes(damaged), HasSubstr("is damaged"));
  EXPECT_THAT(error_of_bytes("450,850"), HasSubstr("no measurement"));
  EXPECT_EQ(second.paths(), 5120u);

  // Parts of whole blocks, added in their order.
  FluxMeter of_parts = meter(request);
  for (const uint64_t begin : {uint64_t{0}, uint64_t{3072}}) {
    FluxMeter part = meter(request);
    part.start_at(begin);
    part.trace(begin == 0 ? 3072 : 5120 - 3072, session.pool());
    of_parts.add(part.part(), "part");
  }
  EXPECT_EQ(of_parts.part().arrays, second.part().arrays);
}

/// A model against itself, and against soils that are brighter by 3 and by 1 %.
TEST_F(Radiometry, TheVerdictKnowsWhatIsWithinTheLimit) {
  using Answer = BrfVerdict::Answer;
  const BrfRequest request{
      .views = {{-40, 0}, {0, 0}, {40, 0}}, .period = kPlot, .wavelengths = "bands,wavelengths=550,800"};
  const BrfMeasurement reference = brf(kSun + soil(0.3), request, 64), brighter = brf(kSun + soil(0.309), request, 64),
                       little = brf(kSun + soil(0.303), request, 64);
  EXPECT_EQ(check_agreement(reference, reference, 0.02).answer, Answer::enough);
  EXPECT_EQ(check_agreement(reference, brighter, 0.02).answer, Answer::not_enough);
  EXPECT_EQ(check_agreement(reference, little, 0.02).answer, Answer::enough);
  EXPECT_NEAR(check_agreement(reference, little, 0.02).worst.mean, 0.01, 1e-5);
  const BrfMeasurement few = brf(kSun + soil(0.3) + canopy(1, lambertian(0.4, 0.4)), request, 2),
                       other = brf(kSun + soil(0.3) + canopy(1, lambertian(0.41, 0.4)), request, 2);
  EXPECT_EQ(check_agreement(few, other, 0.02).answer, Answer::unknown);
}

TEST_F(Radiometry, WalksThatAreFollowedFromTheSensorAreNotJudged) {
  const BrfRequest request{.views = {{0, 0}}, .period = kPlot, .wavelengths = "bands,wavelengths=550"};
  const auto read = [&](const std::string& name) {
    return brf(kSun + soil(0.3) + canopy(1, "Material \"" + name + "\"\n"), request, 1);
  };
  EXPECT_TRUE(read("abm").has_heavy_tails);
  EXPECT_FALSE(read("leaf_solved").has_heavy_tails);
  EXPECT_EQ(check_agreement(read("leaf_solved"), read("abm"), 0.5).answer, BrfVerdict::Answer::unknown);
}

/// With this seed one of the directions lies in the plane of the horizon.
TEST_F(Radiometry, LightFromTheHorizonIsLeftOut) {
  const FluxMeasurement m =
      flux(kSky + soil(0.5), {.wavelengths = "bands,wavelengths=550"}, 1000000, 2, "Option \"integer seed\" 1\n");
  EXPECT_NEAR(m.reflected[0].mean, 0.5, kZ * m.reflected[0].standard_error + 1e-6);
}

TEST_F(Radiometry, WhatCannotBeMeasuredIsRefused) {
  EXPECT_THAT(error_of([&] {
                brf(kSun, {.views = {{0, 0}}, .wavelengths = "bands,wavelengths=450"}, 1);
              }),
              HasSubstr("nothing stands in this scene"));
  EXPECT_THAT(error_of([&] {
                flux(kSun + soil(0.1),
                     {.period = kPlot, .wavelengths = "bands,wavelengths=450", .organs = OrganKind::instance}, 1);
              }),
              HasSubstr("no instances of objects"));
  EXPECT_THAT(error_of([&] {
                brf(kSun + soil(0.1), {.views = {{95, 0}}, .period = kPlot, .wavelengths = "bands,wavelengths=450"}, 1);
              }),
              HasSubstr("not above the horizon"));
}

struct TornBsdf final : Bsdf {
  Lobes flags() const override { return Lobes::reflection | Lobes::diffuse; }
  SampledSpectrum f(const Vec3&, const Vec3&, RandomStream&) const override { return {}; }
  std::optional<BsdfSample> sample(const Vec3&, float, Vec2, RandomStream&) const override {
    throw std::runtime_error("thrown by sample");
  }
  float pdf(const Vec3&, const Vec3&) const override { return 0; }
};
struct Torn final : Material {
  explicit Torn(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena& arena) const override {
    return arena.make<TornBsdf>();
  }
};
const MaterialInfo kTorn{{"material", "torn", "", "", {}}, make_material<Torn>};

TEST_F(Radiometry, AnExceptionDuringFluxNamesItsMaterial) {
  Session session(silent_log(), {2, {}, {}});
  session.add_material(kTorn);
  const std::string text = "WorldBegin\n" + kSun + "Material \"torn\" Shape \"disk\"\n";
  FluxMeter meter(session, session.read_text(text, "test.pbrt"), {.wavelengths = "bands,wavelengths=550"});
  EXPECT_THAT(error_of([&] { meter.trace(1024, session.pool()); }),
              AllOf(HasSubstr("test.pbrt:3"), HasSubstr("material \"torn\" has a defect: thrown by sample")));
}

}  // namespace
}  // namespace frond
