#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;
using test::RenderSettings;

/// All ways in which lights are found.
constexpr const char* kDirect[] = {
    "\"integer lightsamples\" 1 \"integer scatteredrays\" 1", "\"integer lightsamples\" 2 \"integer scatteredrays\" 1",
    "\"integer lightsamples\" 1 \"integer scatteredrays\" 2", "\"integer lightsamples\" 2 \"integer scatteredrays\" 2",
    "\"bool sampledirect\" false"};

/// z-tests below use 5 standard errors: a false alarm in 1.7 million for each.
constexpr double kSigmas = 5;

/// Orthographic camera 1 unit above the origin, looking down on the square [-extent, extent]^2 of the plane z = 0.
std::string plane_from_above(const std::string& world, double extent = 0.01, int size = 4,
                             const std::string& integrator = "\"integer maxdepth\" 1") {
  return fmt::format(R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-{0} {0} -{0} {0}]
Film "rgb" "integer xresolution" {1} "integer yresolution" {1}
Sampler "independent"
PixelFilter "box"
Integrator "path" {2}
WorldBegin
{3}
)",
                     extent, size, integrator, world);
}

const std::string kPlane =
    R"(Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
)";
const std::string kGrey = R"(Material "diffuse" "spectrum reflectance" [360 .4 2500 .4]
)";

double expect_mean(const Film& film, double expected) {
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) {
    const auto [mean, error] = channel_mean(film, c);
    // A part in 10^5 for the float arithmetic of positions and directions.
    EXPECT_NEAR(mean, expected, kSigmas * error + 1e-5 * expected) << "channel " << c;
    worst = std::max(worst, error / expected);
  }
  return worst;
}

// Refraction multiplies radiance by n^2 on entry and by its inverse on exit. Roulette and cut-off must not see this
// factor, or it would terminate or keep paths inside glass.
TEST(Path, LosslessGlassAroundWhiteIsNotSeenInAFurnace) {
  const std::string sky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n";
  const std::string glass =
      "Material \"dielectric\" \"spectrum eta\" [360 1.7 2500 1.7]\n"
      "Shape \"sphere\" \"float radius\" 0.5\n";
  const std::string white =
      "Material \"diffuse\" \"spectrum reflectance\" [360 1 2500 1]\n"
      "Shape \"sphere\" \"float radius\" 0.3\n";
  for (const std::string integrator :
       {"\"integer maxdepth\" 100000",
        "\"integer maxdepth\" 100000 \"string termination\" \"attenuation\" \"float cutoff\" 0.5"})
    for (const std::string& world : {sky + glass, sky + glass + white}) {
      const Film film = render_text(plane_from_above(world, 0.6, 8, integrator), {.samples = 64});
      // All paths have equal weights: no noise except for rounding.
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) EXPECT_NEAR(film.mean(x, y)[1], 1, 1e-3) << x << ", " << y << ", " << integrator;
    }
}

TEST(Path, DistantLightOnADiffusePlane) {
  const Film film = render_text(plane_from_above(
      kGrey + kPlane +
      R"(LightSource "distant" "point3 from" [0 3 4] "point3 to" [0 0 0] "spectrum L" "stdillum-D65" "float scale" 2)"));
  expect_mean(film, 0.4 * 2 * 0.8 / std::numbers::pi);
}

TEST(Path, PointLightFallsOffWithTheSquare) {
  const Film film = render_text(plane_from_above(
      kGrey + kPlane + R"(LightSource "point" "point3 from" [0 0 2] "spectrum I" "stdillum-D65" "float scale" 3)",
      1e-4));
  expect_mean(film, 0.4 * 3 / 4 / std::numbers::pi);
}

TEST(Path, SpotLightIsAPointLightInsideItsCone) {
  const std::string spot =
      R"(LightSource "spot" "point3 from" [0 0 2] "point3 to" [{} 0 0] "spectrum I" "stdillum-D65" "float scale" 3)";
  expect_mean(render_text(plane_from_above(kGrey + kPlane + fmt::format(fmt::runtime(spot), 0), 1e-4)),
              0.4 * 3 / 4 / std::numbers::pi);
  EXPECT_EQ(
      channel_mean(render_text(plane_from_above(kGrey + kPlane + fmt::format(fmt::runtime(spot), 3), 1e-4)), 0).mean,
      0);
}

/// Irradiance under a Lambertian emitter of radiance L, in closed form, with the light in front of the plane at (0, 0,
/// 2).
struct Emitter {
  const char* name;
  std::string shape;
  double form_factor;  ///< irradiance over pi L
};

double square_form_factor(double half, double distance) {
  // Parallel square centred over a differential element (Howell, A Catalog of Radiation Configuration Factors, B-4).
  const double a = half / distance, s = std::sqrt(1 + a * a);
  return 4 / (2 * std::numbers::pi) * (2 * a / s * std::atan(a / s));
}

class AreaLights : public ::testing::TestWithParam<Emitter> {};

TEST_P(AreaLights, IrradianceIsTheFormFactor) {
  const std::string light = R"(AttributeBegin AreaLightSource "diffuse" "spectrum L" "stdillum-D65" Translate 0 0 2 )" +
                            GetParam().shape + " AttributeEnd\n";
  const double expected = 0.4 * GetParam().form_factor;
  for (const char* direct : kDirect) {
    const std::string integrator = fmt::format("\"integer maxdepth\" 1 {}", direct);
    // The camera looks from under the light.
    const Film film = render_text(plane_from_above(kGrey + kPlane + light, 1e-4, 16, integrator), {.samples = 256});
    const double error = expect_mean(film, expected);
    EXPECT_LT(error, 0.02) << "the test has lost its power";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, AreaLights,
    ::testing::Values(
        Emitter{"disk", R"(ReverseOrientation Shape "disk" "float radius" 1)", 1.0 / 5},
        Emitter{
            "disk_two_sided",
            R"(AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "bool twosided" true Shape "disk" "float radius" 1)",
            1.0 / 5},
        Emitter{"sphere", R"(Shape "sphere" "float radius" .9)", 0.81 / 4},
        Emitter{"scaled_sphere", R"(Scale .3 .3 .3 Shape "sphere" "float radius" 3)", 0.81 / 4},
        Emitter{
            "triangles",
            R"(ReverseOrientation Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] "integer indices" [0 1 2  0 2 3])",
            square_form_factor(1, 2)},
        Emitter{"bilinear", R"(ReverseOrientation Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0])",
                square_form_factor(1, 2)}),
    [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(Path, OneSidedEmissionFacesTheFront) {
  const std::string light = R"(AreaLightSource "diffuse" "spectrum L" "stdillum-D65" Translate 0 0 2 Shape "disk")";
  EXPECT_EQ(channel_mean(render_text(plane_from_above(kGrey + kPlane + light, 1e-4)), 0).mean, 0);
}

TEST(Path, HalfAlphaHalvesWhatIsBehindAndTheShadow) {
  // Camera under a half-open white emitter's plane: alpha shows in camera rays and, with a light above, in shadow rays.
  const std::string blocker =
      R"(AttributeBegin Material "diffuse" "spectrum reflectance" [360 0 2500 0] Translate 0 0 1.5 Shape "disk" "float radius" .5 "float alpha" .25 AttributeEnd
)";
  const std::string sun =
      R"(LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65")";
  const Film shadowed = render_text(plane_from_above(kGrey + kPlane + blocker + sun, 0.01, 16), {.samples = 64});
  EXPECT_LT(expect_mean(shadowed, 0.75 * 0.4 / std::numbers::pi), 0.02);
  const std::string screen =
      R"(AttributeBegin Material "diffuse" "spectrum reflectance" [360 0 2500 0] Translate 0 0 .5 Shape "disk" "float radius" .5 "float alpha" .25 AttributeEnd
)";
  // The camera's ray and the shadow ray each pass with probability 3/4.
  const Film twice = render_text(plane_from_above(kGrey + kPlane + screen + sun, 0.01, 16), {.samples = 64});
  EXPECT_LT(expect_mean(twice, 0.75 * 0.75 * 0.4 / std::numbers::pi), 0.02);
}

TEST(Path, WhiteFurnaceIsWhite) {
  for (const char* material :
       {R"("diffuse" "spectrum reflectance" [360 1 2500 1])",
        R"("diffusetransmission" "spectrum reflectance" [360 .5 2500 .5] "spectrum transmittance" [360 .5 2500 .5])"}) {
    for (const char* shape : {R"("sphere" "float radius" .8)", R"("disk" "float radius" .8)",
                              R"("bilinearmesh" "point3 P" [-.7 -.6 0  .8 -.7 .3  -.9 .8 .2  .6 .7 -.3])"}) {
      const std::string world = fmt::format(
          "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\nMaterial {}\nShape {}\n", material, shape);
      const Film film = render_text(plane_from_above(world, 1, 16, "\"integer maxdepth\" 1000"), {.samples = 64});
      EXPECT_LT(expect_mean(film, 1), 0.02) << material << shape;
    }
  }
}

/// Glass conserves energy: under uniform light it is invisible. Each pixel and channel is tested, 432 that may have
/// noise: a false alarm at one change of the seed in 4000.
class GlassFurnace : public ::testing::Test {
 protected:
  static constexpr int kSize = 6;

  static std::string lit_by_the_sky(const std::string& world) {
    return plane_from_above("LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n" + world, 0.9, kSize,
                            "\"integer maxdepth\" 1000 \"float roulette\" 1");
  }
  static void expect_white_pixels(const Film& film, const std::string& what) {
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (size_t c = 0; c < 3; ++c) {
          const double error = std::sqrt(film.variance(x, y)[c]);
          EXPECT_LT(error, 0.05) << "the test has lost its power";
          EXPECT_NEAR(film.mean(x, y)[c], 1, kSigmas * error + 1e-4) << what << ", pixel " << x << ' ' << y;
        }
  }
};

TEST_F(GlassFurnace, WhateverTheShape) {
  const std::string sphere = R"(Shape "sphere" "float radius" .7)";
  const std::string cube = R"(Rotate 40 1 2 3
Shape "trianglemesh" "point3 P" [-.4 -.4 -.4  .4 -.4 -.4  .4 .4 -.4  -.4 .4 -.4  -.4 -.4 .4  .4 -.4 .4  .4 .4 .4  -.4 .4 .4]
"integer indices" [0 2 1  0 3 2  4 5 6  4 6 7  0 1 5  0 5 4  1 2 6  1 6 5  2 3 7  2 7 6  3 0 4  3 4 7])";
  for (const std::string& shape : {sphere, cube})
    for (const char* eta : {R"("float eta" 1.5)", R"("spectrum eta" [360 1.8 2500 1.3])"}) {
      const std::string world = fmt::format("Material \"dielectric\" {}\n{}\n", eta, shape);
      expect_white_pixels(render_text(lit_by_the_sky(world), {.samples = 2048}), world);
    }
}

/// A body in the glass absorbs, and gives off as much of the light that is there, eta^2 times what is outside: all
/// stays white. Paths that have been on it a few times are left to roulette.
TEST_F(GlassFurnace, AroundABodyThatLeavesPathsToRoulette) {
  constexpr double kAlbedo = 0.3;
  for (const double eta : {1.5, 0.7}) {
    const std::string world = fmt::format(
        R"(AttributeBegin Material "dielectric" "float eta" {} Shape "sphere" "float radius" .8 AttributeEnd
Material "diffuse" "spectrum reflectance" [360 {} 2500 {}]
AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "float scale" {} Shape "sphere" "float radius" .7
)",
        eta, kAlbedo, kAlbedo, eta * eta * (1 - kAlbedo));
    RenderStatistics statistics;
    expect_white_pixels(render_text(lit_by_the_sky(world), {.samples = 4096, .statistics = &statistics}), world);
    const auto& absorbed = statistics.ends.absorbed;
    EXPECT_GT(std::accumulate(absorbed.begin(), absorbed.end(), uint64_t{0}), statistics.paths / 200);
    EXPECT_EQ(absorbed.back(), 0u) << "cut off: roulette would have ended them before";
  }
}

TEST(Path, LightSamplingAndScatteringAgreeInAClosedBox) {
  // Inside a sphere of albedo a that glows with L, radiance is L / (1 - a) everywhere.
  const std::string world = R"(AttributeBegin Material "diffuse" "spectrum reflectance" [360 .6 2500 .6]
AreaLightSource "diffuse" "spectrum L" "stdillum-D65" ReverseOrientation Shape "sphere" "float radius" 2 AttributeEnd
)";
  for (const char* direct : kDirect) {
    const std::string integrator = fmt::format("\"integer maxdepth\" 100000 {}", direct);
    const Film film = render_text(plane_from_above(world, 0.5, 16, integrator), {.samples = 256});
    EXPECT_LT(expect_mean(film, 1 / (1 - 0.6)), 0.01);
  }
}

TEST(Path, DepthLimitsTheSeries) {
  const std::string world = R"(AttributeBegin Material "diffuse" "spectrum reflectance" [360 .6 2500 .6]
AreaLightSource "diffuse" "spectrum L" "stdillum-D65" ReverseOrientation Shape "sphere" "float radius" 2 AttributeEnd
)";
  for (int depth = 0; depth < 4; ++depth) {
    const Film film =
        render_text(plane_from_above(world, 0.5, 16, fmt::format("\"integer maxdepth\" {}", depth)), {.samples = 64});
    expect_mean(film, (1 - std::pow(0.6, depth + 1)) / (1 - 0.6));
  }
}

TEST(Path, SeveralLightsAddUpHoweverTheyAreChosen) {
  const std::string lights =
      R"(LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65" "float scale" 2
LightSource "point" "point3 from" [0 0 2] "spectrum I" "stdillum-D65" "float scale" 8
LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" .5
)";
  const double expected = 0.4 * (2 + 8 / 4.0 + 0.5 * std::numbers::pi) / std::numbers::pi;
  for (const char* selector : {"power", "uniform", "bvh"})
    for (const char* direct : {kDirect[0], kDirect[1]}) {
      const std::string integrator =
          fmt::format("\"integer maxdepth\" 1 {} \"string lightsampler\" \"{}\"", direct, selector);
      const Film film = render_text(plane_from_above(kGrey + kPlane + lights, 1e-4, 16, integrator), {.samples = 256});
      EXPECT_LT(expect_mean(film, expected), 0.02) << selector;
    }
}

TEST(Path, InstancesLookLikeWhatTheyCopy) {
  const std::string light =
      "LightSource \"distant\" \"point3 from\" [1 2 3] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-D65\"\n";
  const std::string shapes = R"(Shape "sphere" "float radius" .3
Shape "trianglemesh" "point3 P" [-.9 -.9 0  0 -.8 .1  -.5 0 .2] "normal N" [0 0 1  .1 0 1  0 .1 1] "integer indices" [0 1 2]
)";
  const std::string moved = "Translate .2 .1 0 Rotate 30 1 2 3 Scale 1 .5 -1\n";
  const std::string direct =
      plane_from_above(kGrey + light + "AttributeBegin " + moved + shapes + "AttributeEnd", 1, 32);
  const std::string instanced =
      plane_from_above(kGrey + light + "ObjectBegin \"o\"\n" + shapes + "ObjectEnd AttributeBegin " + moved +
                           "ObjectInstance \"o\" AttributeEnd",
                       1, 32);
  const Film a = render_text(direct), b = render_text(instanced);
  int differing = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) differing += std::abs(a.mean(x, y)[1] - b.mean(x, y)[1]) > 1e-4;
  // Rays that graze an edge may fall on either side of it by rounding.
  EXPECT_LE(differing, 5);
  EXPECT_GT(channel_mean(a, 1).mean, 0.005);
}

TEST(Path, TheSameBitsOnAnyNumberOfThreads) {
  const std::string scene = plane_from_above(
      kGrey + kPlane +
          R"(Material "leaf_simplified" "string tablemethod" "solve" Translate 0 0 .3 Shape "disk" "float radius" .5
LightSource "infinite" "spectrum L" "stdillum-D65")",
      1, 33, "\"integer maxdepth\" 8");
  const Film one = render_text(scene, {.samples = 4, .threads = 1});
  for (const int threads : {2, 3, 7}) {
    const Film more = render_text(scene, {.samples = 4, .threads = threads});
    ASSERT_TRUE(one == more) << threads << " threads";
  }
}

TEST(Path, HeroAndFixedWavelengthsAgreeOnGrey) {
  const std::string scene = plane_from_above(
      kGrey + kPlane + R"(LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65")",
      0.01, 16);
  const Film film = render_text(scene, {.samples = 256, .wavelengths = "hero"});
  const auto [y, error] = channel_mean(film, 1);  // channels are XYZ here
  EXPECT_NEAR(y, 0.4 / std::numbers::pi, kSigmas * error);
  EXPECT_LT(error, 0.01 * y);
}

TEST(Path, CountsHowPathsEnd) {
  const std::string light = R"(LightSource "infinite" "spectrum L" "stdillum-D65"
)";
  const std::string half = R"(Material "diffusetransmission" "spectrum reflectance" [360 .25 2500 .25]
"spectrum transmittance" [360 .25 2500 .25]
)";
  const std::string black = R"(Material "diffuse" "spectrum reflectance" [360 0 2500 0]
)";
  const std::string below = "Translate 0 0 -1\n";
  RenderStatistics s;
  const RenderSettings settings{.statistics = &s};
  constexpr uint64_t kPaths = 4 * 4 * 16;

  render_text(plane_from_above(light), settings);
  EXPECT_EQ(s.ends.escaped[0], kPaths);
  render_text(plane_from_above(light + black + kPlane), settings);
  EXPECT_EQ(s.ends.absorbed[0], kPaths);
  render_text(plane_from_above(light + kGrey + kPlane), settings);
  EXPECT_EQ(s.ends.escaped[1], kPaths);
  // Transmitted light is absorbed by the black plane beneath the sheet, which is wide but finite.
  render_text(plane_from_above(light + half + kPlane + below + black + kPlane), settings);
  EXPECT_EQ(s.ends.escaped[1] + s.ends.absorbed[1], kPaths);
  EXPECT_NEAR(double(s.ends.absorbed[1]), kPaths / 2.0, kSigmas * std::sqrt(kPaths / 4.0));
}

}  // namespace
}  // namespace frond
