// The integrator volpath where media meet instances, glass, motion, empty bands and plug-ins that throw.

#include <cmath>
#include <stdexcept>

#include "tests/integrators/layers.h"

namespace frond {
namespace {

using namespace test;

/// Compares two independent estimates. The z-tests, one for each band, use 5 standard errors: a false alarm in 1.7
/// million for each.
void expect_same_mean(const BandMeans& a, const BandMeans& b) {
  for (size_t i = 0; i < kBands.size(); ++i) {
    EXPECT_GT(a.mean[i], 0);
    EXPECT_NEAR(a.mean[i], b.mean[i], kSigmas * std::hypot(a.error[i], b.error[i])) << kBands[i] << " nm";
  }
}

/// The scene with and without light samples.
void expect_light_samples_do_not_matter(const std::string& world, int samples) {
  const std::string with = looking_down(world, 20);
  std::string without = with;
  without.insert(without.find("\"integer maxdepth\""), "\"bool sampledirect\" false ");
  expect_same_mean(band_means(with, samples), band_means(without, samples));
}

const std::string kAbsorbing = R"("string type" "homogeneous" "spectrum sigma_a" [400 .3 700 2.4] "float sigma_s" 0)";

// The medium is inside of each: the camera sees through a layer of thickness 1, and through nothing else.
TEST(VolPathMedia, InsideOfAMirroredInstanceStaysInside) {
  const auto transmitted = [](double nm) { return std::exp(-ramp(nm, 0.3, 2.4)); };
  const std::string ball = "Material \"interface\"\nMediumInterface \"m\" \"\"\nShape \"sphere\" \"float radius\" .5\n";
  for (const std::string& object : {layer(kAbsorbing), "MakeNamedMedium \"m\" " + kAbsorbing + "\n" + ball})
    for (const std::string placed :
         {"Scale 1 1 -1 ObjectInstance \"o\"", "Scale -1 1 1 ObjectInstance \"o\"",
          "Scale -1 -1 1 ObjectInstance \"o\"", "Rotate 30 0 0 1 Scale -1 1 1 Rotate 30 0 0 1 ObjectInstance \"o\""})
      expect_radiance(looking_down(kSky + "ObjectBegin \"o\"\n" + object + "ObjectEnd\n" + placed), 1024, transmitted);
  // A quadric that is mirrored itself is turned inside out, as in pbrt-v4.
  for (const std::string sides : {"\"\" \"m\"\n", "\"m\" \"\"\nReverseOrientation\n"})
    expect_radiance(looking_down(kSky + "MakeNamedMedium \"m\" " + kAbsorbing +
                                 "\nMaterial \"interface\"\nScale -1 1 1\nMediumInterface " + sides +
                                 "Shape \"sphere\" \"float radius\" .5\n"),
                    1024, transmitted);
}

const std::string kBox = R"( "point3 p0" [-100 -100 -1] "point3 p1" [100 100 0])";

// One band is not affected by the medium; the others are. The density is a grid of one cell, whose integral over the
// layer is 3/4.
TEST(VolPathMedia, AGridMayBeEmptyInOneBand) {
  expect_radiance(looking_down(kSky + layer(R"("string type" "uniformgrid" "float density" 1 "float sigma_s" 0
                                   "spectrum sigma_a" [450 2 550 0 552 0 650 1])" +
                                            kBox)),
                  4096, [](double nm) {
                    return std::exp(-0.75 * (nm == 450 ? 2 : nm == 551 ? 0 : 1));
                  });
}

// No light is lost where the medium only scatters, in the band in which there is none included.
TEST(VolPathMedia, AScatteringGridMayBeEmptyInOneBand) {
  expect_radiance(looking_down(kSky + layer(R"("string type" "uniformgrid" "float density" 1 "float sigma_a" 0
                                   "spectrum sigma_s" [450 2 550 0 552 0 650 1])" +
                                            kBox),
                               1000),
                  2048, [](double) { return 1.0; });
}

// An even sky seen in a slab of glass that absorbs: R + (1 - R)^2 t / (1 - R t), where R is the reflectance of one face
// at normal incidence and t the transmittance of one passage, both different in each band.
TEST(VolPathMedia, DispersiveGlassAttenuates) {
  std::string slab = layer(kAbsorbing);
  const std::string glass = "\"dielectric\" \"spectrum eta\" [400 1.6 700 1.4]";
  slab.replace(slab.find("\"interface\""), 11, glass);
  // The lower face has its front below the glass.
  slab.replace(slab.find("MediumInterface \"\" \"m\""), 22, "ReverseOrientation MediumInterface \"m\" \"\"");
  expect_radiance(looking_down(kSky + slab, 100), 8192, [](double nm) {
    const double eta = ramp(nm, 1.6, 1.4), r = std::pow((eta - 1) / (eta + 1), 2), t = std::exp(-ramp(nm, 0.3, 2.4));
    return r + (1 - r) * (1 - r) * t / (1 - r * t);
  });
}

TEST(VolPathMedia, LightSamplesDoNotChangeTheMeanOfAGrid) {
  std::string densities;
  RandomStream rng(5);
  for (int i = 0; i < 4 * 4 * 4; ++i) densities += fmt::format(" {}", rng.uniform() < 0.4f ? 0 : 4 * rng.uniform());
  expect_light_samples_do_not_matter(layer(R"("string type" "uniformgrid" "integer nx" 4 "integer ny" 4 "integer nz" 4
    "point3 p0" [-1 -1 -1] "point3 p1" [1 1 0] "float g" .5 "spectrum sigma_a" [400 .2 700 .1]
    "spectrum sigma_s" [400 1 700 3] "float density" [)" +
                                           densities + "]") +
                                         R"(
AttributeBegin
AreaLightSource "diffuse" "spectrum L" [300 1 900 1]
Translate 1 0 .8
Shape "sphere" "float radius" .5
AttributeEnd
)",
                                     8192);
}

// A black ball hides a lamp from the layer while the shutter opens, and is far away soon. Rays that a medium scatters
// see it at the moment of their path.
TEST(VolPathMedia, ScatteredRaysKeepTheirTime) {
  expect_light_samples_do_not_matter(layer(R"("string type" "homogeneous" "float sigma_a" .2 "float sigma_s" 1)") + R"(
AttributeBegin
AreaLightSource "diffuse" "spectrum L" [300 1 900 1]
Translate 2 0 2
Shape "sphere"
AttributeEnd
Material "diffuse" "spectrum reflectance" [300 0 900 0]
ActiveTransform EndTime
Translate 0 0 5
ActiveTransform All
Translate 1 0 1
Shape "sphere" "float radius" .8
)",
                                     4096);
}

struct Torn final : Material {
  explicit Torn(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override {
    throw std::runtime_error("thrown by evaluate");
  }
};
const MaterialInfo kTorn{{"material", "torn", "", "", {}}, make_material<Torn>};

// The camera sees a floor, or fog; only shadow rays meet the ball.
TEST(VolPathMedia, AnExceptionInAShadowRayNamesItsMaterial) {
  for (const std::string& seen : {std::string("Material \"diffuse\"\nShape \"disk\" \"float radius\" .1\n"),
                                  layer(R"("string type" "homogeneous" "float sigma_s" 50)")}) {
    const std::string text = looking_down("LightSource \"point\" \"point3 from\" [4 0 4]\n" + seen +
                                          "Material \"torn\"\nTranslate 2 0 2\nShape \"sphere\"\n");
    try {
      (void)render_text(text, {.samples = 16, .materials = {&kTorn}});
      ADD_FAILURE() << "nothing was thrown";
    } catch (const SurfaceError& error) {
      const SceneDescription scene = parse_scene_text(text, "test.pbrt", silent_log());
      EXPECT_EQ(scene.materials.at(error.material_id).plugin.name, "torn");
      EXPECT_STREQ(error.what(), "thrown by evaluate");
    }
  }
}

}  // namespace
}  // namespace frond
