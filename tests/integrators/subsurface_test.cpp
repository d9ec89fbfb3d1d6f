// Integrators path and volpath with material "subsurface", against closed forms and each other.

#include "materials/lobes/beam_diffusion.h"
#include "materials/lobes/fresnel.h"
#include "tests/integrators/layers.h"

namespace frond {
namespace {

using namespace test;

constexpr double kEta = 1.4, kG = 0.3;
const std::string kWidePlane =
    "Shape \"trianglemesh\" \"point3 P\" [-900 -900 0  900 -900 0  900 900 0  -900 900 0] \"integer indices\" "
    "[0 1 2  0 2 3]\n";
/// Mean free paths and albedos that differ by band.
const std::string kFlesh =
    "Material \"subsurface\" \"spectrum sigma_a\" [400 .02 700 4] \"spectrum sigma_s\" [400 40 700 2] \"float eta\" "
    "1.4 \"float g\" .3\n";

const BeamDiffusion& table() {
  static const BeamDiffusion made(kG, kEta, ThreadPool(1));
  return made;
}

/// Radiance of a plane under a sky of radiance 1, by the table's reflectance: the profile is 0 beyond the radius within
/// which 0.999 of the light leaves, so that the lower end is 0.1 % less.
void expect_furnace(const std::string& world, const std::string& integrator) {
  const BandMeans seen = band_means(looking_down(kSky + world, 5, integrator), 1024);
  const double reflected = double(fresnel_dielectric(1, float(kEta)));
  for (size_t i = 0; i < kBands.size(); ++i) {
    const double a = ramp(kBands[i], 0.02, 4), s = ramp(kBands[i], 40, 2);
    const double truth = reflected + (1 - reflected) * double(table().reflectance(float(s / (a + s))));
    const double unit = sky_radiance(), mean = seen.mean[i] / unit, error = seen.error[i] / unit;
    EXPECT_LT(mean, truth + kSigmas * error) << kBands[i] << " nm";
    EXPECT_GT(mean, truth * 0.999 - kSigmas * error) << kBands[i] << " nm";
  }
}

void expect_same(const std::string& a, const std::string& b, int samples) {
  const BandMeans first = band_means(a, samples), second = band_means(b, samples);
  for (size_t i = 0; i < kBands.size(); ++i) {
    EXPECT_GT(first.mean[i], 0);
    EXPECT_NEAR(first.mean[i], second.mean[i], kSigmas * std::hypot(first.error[i], second.error[i]))
        << kBands[i] << " nm";
  }
}

TEST(SubsurfacePaths, APlaneReflectsWhatTheTableSaysInEachLane) {
  for (const std::string integrator : {"path", "volpath"}) expect_furnace(kFlesh + kWidePlane, integrator);
}

// Random walks in the same half-space: photon beam diffusion is 6 % brighter at this albedo (docs/pbrt.md).
TEST(SubsurfacePaths, RandomWalksReturnNearlyAsMuch) {
  const std::string grey = "\"float sigma_a\" .5 \"float sigma_s\" 9.5";
  const std::string walked = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" " + grey +
                             "\nMediumInterface \"m\" \"\"\nMaterial \"dielectric\" \"float eta\" 1.33\n";
  const std::string looked_up =
      "Material \"subsurface\" \"spectrum sigma_a\" [300 .5 900 .5] \"spectrum sigma_s\" [300 9.5 900 9.5]\n";
  const BandMeans walk = band_means(looking_down(kSky + walked + kWidePlane, 10000), 256);
  const BandMeans table = band_means(looking_down(kSky + looked_up + kWidePlane), 256);
  for (size_t i = 0; i < kBands.size(); ++i)
    EXPECT_NEAR(table.mean[i] / walk.mean[i], 1.06, 0.02 + kSigmas * walk.error[i] / walk.mean[i])
        << kBands[i] << " nm";
}

// Segments are traced at the path's time: at another the plane would be elsewhere.
TEST(SubsurfacePaths, AMovingPlaneIsFound) {
  expect_furnace(kFlesh + "ActiveTransform EndTime Translate 0 0 3 ActiveTransform All\n" + kWidePlane, "path");
}

const std::string kRoundLamp =
    "AttributeBegin\nAreaLightSource \"diffuse\" \"spectrum L\" [300 1 900 1]\nTranslate 2 0 3\nShape \"sphere\"\n"
    "AttributeEnd\n";
const std::string kUnitBox = R"(Shape "trianglemesh" "point3 P" [0 -1 -1  1 -1 -1  1 1 -1  0 1 -1  0 -1 0  1 -1 0  1 1 0
  0 1 0] "integer indices" [0 2 1  0 3 2  4 5 6  4 6 7  0 1 5  0 5 4  1 2 6  1 6 5  2 3 7  2 7 6  3 0 4  3 4 7]
)";

// Light passes from one instance to the other, as they have the same material.
TEST(SubsurfacePaths, InstancesAreOneBody) {
  const std::string object = "ObjectBegin \"o\"\n" + kFlesh + kUnitBox + "ObjectEnd\n";
  const std::string instances =
      kRoundLamp + object + "ObjectInstance \"o\"\nTranslate -1.03 0 0\nObjectInstance \"o\"\n";
  const std::string shapes = kRoundLamp + kFlesh + kUnitBox + "Translate -1.03 0 0\n" + kUnitBox;
  expect_same(looking_down(instances, 5, "path"), looking_down(shapes, 5, "volpath"), 512);
}

// Lights are found by light samples, by scattered rays, or by both.
TEST(SubsurfacePaths, LightSamplesDoNotMatter) {
  for (const std::string integrator : {"path", "volpath"}) {
    const std::string with = looking_down(kRoundLamp + kFlesh + "Shape \"sphere\"\n", 5, integrator);
    std::string without = with;
    without.insert(without.find("\"integer maxdepth\""), "\"bool sampledirect\" false ");
    expect_same(with, without, 512);
  }
}

// A rough interface samples lights as well; those behind the surface light the medium through exits alone.
TEST(SubsurfacePaths, ARoughInterfaceOfTwoRaysHasTheSameMean) {
  std::string rough = kFlesh;
  rough.insert(rough.size() - 1, " \"float roughness\" .2");
  const std::string world = kRoundLamp + rough + kWidePlane + "Translate 0 0 -3\n" + kRoundLamp;
  std::string two = looking_down(world, 5, "path");
  two.insert(two.find("\"integer maxdepth\""), "\"integer scatteredrays\" 2 ");
  expect_same(two, looking_down(world, 5, "volpath"), 512);
}

// No body sends out more light than it gets, even where photon beam diffusion would.
TEST(SubsurfacePaths, AWhiteBodyIsNotBrighterThanTheSky) {
  const std::string body = "\"spectrum sigma_a\" [300 0 900 0] \"spectrum sigma_s\" [300 30 900 300] \"float g\" -.9\n";
  const BandMeans seen =
      band_means(looking_down(kSky + "Material \"subsurface\" " + body + "Shape \"sphere\"\n", 100, "path"), 1024);
  for (size_t i = 0; i < kBands.size(); ++i) {
    EXPECT_LT(seen.mean[i] / sky_radiance(), 1 + kSigmas * seen.error[i] / sky_radiance());
    EXPECT_GT(seen.mean[i] / sky_radiance(), 0.9);
  }
}

}  // namespace
}  // namespace frond
