#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using testing::channel_mean;
using testing::render_text;

/// Two sheets under a lamp and a sky, above a ground: one that reflects and transmits the share `bright`, and one that
/// reflects and transmits the share `dark`.
std::string scene(const std::string& integrator, const char* bright, const char* dark, const char* film = "") {
  return fmt::format(R"(
LookAt 0 -1 3  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 32 "integer yresolution" 32 {}
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 50 "integer lightsamples" 1 {}
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 0.1
AttributeBegin AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "bool twosided" true
Translate 0 0 4 Shape "disk" "float radius" 0.5 AttributeEnd
AttributeBegin Material "diffuse" "spectrum reflectance" [360 .5 2500 .5]
Translate 0 0 -1 Shape "disk" "float radius" 9 AttributeEnd
AttributeBegin Material "diffusetransmission" "spectrum reflectance" [360 {} 2500 {}] "spectrum transmittance" [360 {} 2500 {}]
Rotate 40 1 0 0 Translate -1 0 0 Shape "disk" AttributeEnd
AttributeBegin Material "diffusetransmission" "spectrum reflectance" [360 {} 2500 {}] "spectrum transmittance" [360 {} 2500 {}]
Rotate -40 1 0 0 Translate 1 0 0 Shape "disk" AttributeEnd
)",
                     film, integrator, bright, bright, bright, bright, dark, dark, dark, dark);
}

const std::string kOne = "\"integer scatteredrays\" 1", kTwo = "\"integer scatteredrays\" 2";

// 5 standard errors: a false alarm in 1.7 million. Also where attenuation ends paths, and without
// light samples.
TEST(ScatteredRays, TwoHaveLessNoiseAndTheSameMean) {
  for (const char* manner : {"", R"( "string termination" "attenuation")", R"( "bool sampledirect" false)"}) {
    const Film one = render_text(scene(kOne + manner, ".45", ".45"), {.samples = 256});
    const Film two = render_text(scene(kTwo + manner, ".45", ".45"), {.samples = 256});
    const auto a = channel_mean(one, 1), b = channel_mean(two, 1);
    EXPECT_NEAR(a.mean, b.mean, 5 * std::hypot(a.error, b.error)) << manner;
    EXPECT_LT(b.error, 0.95 * a.error) << manner;
    EXPECT_LT(a.error, 0.01 * a.mean) << "the test has lost its power" << manner;
  }
}

// The decisions are seen in the bits of three pixels: of the bright sheet, the dark one and the ground.
TEST(ScatteredRays, AreTwoForMaterialsThatReflectAndTransmitMostLight) {
  const auto pixels = [](const std::string& integrator) {
    const Film image = render_text(scene(integrator, ".45", ".1"), {.samples = 16});
    return std::array{image.mean(27, 16), image.mean(5, 16), image.mean(16, 2)};
  };
  const auto one = pixels(kOne), two = pixels(kTwo), adapted = pixels("");
  for (int i = 0; i < 3; ++i) EXPECT_NE(one[i], two[i]) << i;
  EXPECT_EQ(adapted[0], two[0]);
  EXPECT_EQ(adapted[1], one[1]);
  EXPECT_EQ(adapted[2], one[2]);
}

/// An opaque sheet above a ground, or without it, under a uniform sky. No light is sampled.
Film under_sky(const std::string& integrator, bool has_ground) {
  return render_text(fmt::format(R"(
LookAt 0 -2 3  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Integrator "path" "integer maxdepth" 50 {}
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffuse" "spectrum reflectance" [360 .4 2500 .4]
Shape "disk"
{}
)",
                                 integrator, has_ground ? R"(Translate 0 0 -.5 Shape "disk" "float radius" 4)" : ""),
                     {.samples = 16});
}

// The sky is noise where surfaces hide it from one another, else only the edge is.
TEST(ScatteredRays, AreTwoUnderASkyWhereThisHasLessNoiseInTheSameTime) {
  EXPECT_TRUE(under_sky("", true) == under_sky(kTwo, true));
  EXPECT_FALSE(under_sky("", true) == under_sky(kOne, true));
  EXPECT_TRUE(under_sky("", false) == under_sky(kOne, false));
  EXPECT_FALSE(under_sky("", false) == under_sky(kTwo, false));
}

// Otherwise the parts of an image would not fit together.
TEST(ScatteredRays, DoNotDependOnTheCrop) {
  const Film whole = render_text(scene("", ".45", ".1"));
  const Film part = render_text(scene("", ".45", ".1", "\"float cropwindow\" [.25 .5 .5 .75]"));
  for (int y = 16; y < 24; ++y)
    for (int x = 8; x < 16; ++x) ASSERT_EQ(part.mean(x, y), whole.mean(x, y)) << x << ", " << y;
}

// A sheet that returns all light is as bright as the uniform sky around it, with one ray and with two.
TEST(ScatteredRays, ConserveEnergy) {
  const auto image = [](const std::string& integrator) {
    return render_text(fmt::format(R"(
LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" 10
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
Integrator "path" "integer maxdepth" 100 {}
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffusetransmission" "spectrum reflectance" [360 .6 2500 .6] "spectrum transmittance" [360 .4 2500 .4]
Rotate 30 1 0 0 Shape "disk"
)",
                                   integrator),
                       {.samples = 16});
  };
  const Film one = image(kOne), two = image(kTwo);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(two.mean(x, y)[1], one.mean(x, y)[1], 1e-5 * one.mean(x, y)[1]);
}

}  // namespace
}  // namespace frond
