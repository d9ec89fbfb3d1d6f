#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::rays_of;
using test::render_text;

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

/// With the same roulette, which a pilot selects by what it selects else.
std::string rays(int count) { return fmt::format("\"float roulette\" 4 \"integer scatteredrays\" {}", count); }

// 5 standard errors: a false alarm in 1.7 million. Also where attenuation ends paths, and without
// light samples.
TEST(ScatteredRays, TwoHaveLessNoiseAndTheSameMean) {
  for (const char* manner : {"", R"( "string termination" "attenuation")", R"( "bool sampledirect" false)"}) {
    const auto one = channel_mean(render_text(scene(rays(1) + manner, ".45", ".45"), {.samples = 256}), 1);
    const auto two = channel_mean(render_text(scene(rays(2) + manner, ".45", ".45"), {.samples = 256}), 1);
    EXPECT_NEAR(two.mean, one.mean, 5 * std::hypot(two.error, one.error)) << manner;
    EXPECT_LT(two.error, 0.95 * one.error) << manner;
    EXPECT_LT(one.error, 0.01 * one.mean) << "the test has lost its power" << manner;
  }
}

/// Number of rays that a render with a pilot scatters, from renders with a stated number.
class ScatteredByPilot {
 public:
  explicit ScatteredByPilot(const std::function<Film(const std::string&)>& render)
      : adapted_(render(rays(0))), one_(render(rays(1))), two_(render(rays(2))) {}
  /// At a pixel, from the bits of its colour; 0 if it is neither one nor two, or if both have the same bits.
  int at(int x, int y) const {
    return number(adapted_.mean(x, y) == one_.mean(x, y), adapted_.mean(x, y) == two_.mean(x, y));
  }
  /// In all pixels, from the number of rays; 0 if it is neither one nor two.
  int everywhere() const { return number(rays_of(adapted_) == rays_of(one_), rays_of(adapted_) == rays_of(two_)); }

 private:
  static int number(bool is_one, bool is_two) { return is_one == is_two ? 0 : is_one ? 1 : 2; }

  Film adapted_, one_, two_;
};

/// A sheet above a ground, or without it, under a uniform sky. No light is sampled.
Film under_sky(const std::string& integrator, const char* reflectance, bool has_ground) {
  return render_text(fmt::format(R"(
LookAt 0 -2 3  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Integrator "path" "integer maxdepth" 50 {}
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffuse" "spectrum reflectance" [360 {} 2500 {}]
Shape "disk"
{}
)",
                                 integrator, reflectance, reflectance,
                                 has_ground ? R"(Translate 0 0 -.5 Shape "disk" "float radius" 4)" : ""),
                     {.samples = 16});
}

// The sky is noise where surfaces hide it from one another, else only the edge is.
TEST(ScatteredRays, AreTwoUnderASkyWhereThisHasLessNoiseInTheSameTime) {
  const ScatteredByPilot with([](const std::string& integrator) { return under_sky(integrator, ".4", true); });
  const ScatteredByPilot without([](const std::string& integrator) { return under_sky(integrator, ".4", false); });
  EXPECT_EQ(with.everywhere(), 2);
  EXPECT_EQ(without.everywhere(), 1);
}

// The pixels show the bright sheet and the dark one. The light of the lamp is sampled, so that scattered rays cause
// noise mostly on the bright one.
TEST(ScatteredRays, AreTwoForTheMaterialsThatCauseTheNoise) {
  const ScatteredByPilot found(
      [](const std::string& integrator) { return render_text(scene(integrator, ".45", ".02"), {.samples = 16}); });
  EXPECT_EQ(found.at(27, 16), 2);
  EXPECT_EQ(found.at(5, 16), 1);
}

// Otherwise the parts of an image would not fit together.
TEST(ScatteredRays, DoNotDependOnTheCrop) {
  const Film whole = render_text(scene("", ".45", ".1"));
  const Film part = render_text(scene("", ".45", ".1", "\"float cropwindow\" [.25 .5 .5 .75]"));
  for (int y = 16; y < 24; ++y)
    for (int x = 8; x < 16; ++x) ASSERT_EQ(part.mean(x, y), whole.mean(x, y)) << x << ", " << y;
}

// A sheet that returns all light is as bright as the uniform sky, with one ray and with two.
TEST(ScatteredRays, ConserveEnergy) {
  const auto image = [](const std::string& integrator, bool has_sheet) {
    return render_text(fmt::format(R"(
LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" 10
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
Integrator "path" "integer maxdepth" 100 {}
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffusetransmission" "spectrum reflectance" [360 .6 2500 .6] "spectrum transmittance" [360 .4 2500 .4]
{}
)",
                                   integrator, has_sheet ? "Rotate 30 1 0 0 Shape \"disk\"" : ""),
                       {.samples = 16});
  };
  const double sky = image("", false).mean(0, 0)[1];
  for (const int count : {1, 2}) {
    const Film film = image(rays(count), true);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) EXPECT_NEAR(film.mean(x, y)[1], sky, 1e-5 * sky) << count;
  }
}

}  // namespace
}  // namespace frond
