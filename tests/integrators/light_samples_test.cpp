#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

/// A plane and a small ball of this albedo under a wide lamp; as a box, with a small lamp inside a closed sphere.
std::string scene(const std::string& integrator, const char* albedo, bool is_box, const char* film = "") {
  return fmt::format(R"(
LookAt 0 -1 1  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 32 "integer yresolution" 32 {}
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 50 {}
WorldBegin
AttributeBegin AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "bool twosided" true
Translate 0 0 2 Shape "disk" "float radius" {} AttributeEnd
Material "diffuse" "spectrum reflectance" [360 {} 2500 {}]
Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
Shape "sphere" "float radius" .2
{}
)",
                     film, integrator, is_box ? "0.1" : "1", albedo, albedo,
                     is_box ? "ReverseOrientation Shape \"sphere\" \"float radius\" 3" : "");
}

std::string samples(int count) { return fmt::format("\"integer lightsamples\" {}", count); }

// 5 standard errors: a false alarm in 1.7 million.
TEST(LightSamples, TwoHaveLessNoiseAndTheSameMean) {
  const auto one = channel_mean(render_text(scene(samples(1), ".3", false), {.samples = 64}), 1);
  const auto two = channel_mean(render_text(scene(samples(2), ".3", false), {.samples = 64}), 1);
  EXPECT_NEAR(two.mean, one.mean, 5 * std::hypot(two.error, one.error));
  EXPECT_LT(two.error, 0.8 * one.error);
  EXPECT_LT(one.error, 0.002 * one.mean) << "the test has lost its power";
}

// The decision is seen in the bits. The second scene is a closed box of albedo 0.9, where few of all rays go to the
// lamp from a first hit, and most of the noise is that of later ones.
TEST(LightSamples, AreTwoWhereThisPays) {
  const auto image = [](const std::string& integrator, const char* albedo, bool is_box) {
    return render_text(scene("\"float roulette\" 1 \"integer scatteredrays\" 1 " + integrator, albedo, is_box),
                       {.samples = 16});
  };
  EXPECT_TRUE(image("", ".3", false) == image(samples(2), ".3", false));
  EXPECT_FALSE(image("", ".3", false) == image(samples(1), ".3", false));
  EXPECT_TRUE(image("", ".9", true) == image(samples(1), ".9", true));
}

/// Variance of a pixel between two renders of a plane under lamps at these places, mean over the pixels.
double variance_under(const std::vector<const char*>& places, const char* selection, int samples) {
  std::string text = fmt::format(R"(
LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Integrator "path" "integer maxdepth" 1 "integer lightsamples" 1 "string lightsampler" "{}"
WorldBegin
Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
AreaLightSource "diffuse" "spectrum L" "stdillum-D65"
)",
                                 selection);
  for (const char* place : places)
    text += fmt::format("AttributeBegin Translate {} ReverseOrientation Shape \"disk\" AttributeEnd\n", place);
  const Film a = render_text(text, {.samples = samples, .seed = 1}),
             b = render_text(text, {.samples = samples, .seed = 2});
  double sum = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) sum += std::pow(double(a.mean(x, y)[1]) - double(b.mean(x, y)[1]), 2) / 2;
  return sum / (32 * 32);
}

// Each of two lamps has 32 of 64 samples. Their variance is 2.2 to 2.5 times that of 32 samples of one lamp alone:
// their places in the pixel are a random subset. If those on the lamp were one too, it would be 21 to 25 times
// (measured). A mean of 1024 squares has a standard error of some 5 %, so the bound is far from both.
TEST(LightSamples, OfEachLightAreEvenlySpread) {
  const char *left = "-2 0 2", *right = "2 0 2";
  for (const char* selection : {"uniform", "power", "bvh"}) {
    const double both = variance_under({left, right}, selection, 64);
    const double each = variance_under({left}, selection, 32) + variance_under({right}, selection, 32);
    EXPECT_LT(both, 4 * each) << selection;
  }
}

// Otherwise the parts of an image would not fit together.
TEST(LightSamples, DoesNotDependOnTheCrop) {
  const Film whole = render_text(scene("", ".3", false));
  const Film part = render_text(scene("", ".3", false, "\"float cropwindow\" [.25 .5 .5 .75]"));
  for (int y = 16; y < 24; ++y)
    for (int x = 8; x < 16; ++x) ASSERT_EQ(part.mean(x, y), whole.mean(x, y)) << x << ", " << y;
}

}  // namespace
}  // namespace frond
