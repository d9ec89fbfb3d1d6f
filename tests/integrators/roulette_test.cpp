#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

/// A dark floor under a small lamp, half of it in the shadow of a roof, and a bright wall behind both.
Film room(const std::string& integrator, int samples) {
  return render_text(fmt::format(R"(
LookAt 0 -2 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Integrator "path" "integer maxdepth" 50 "integer lightsamples" 1 "integer scatteredrays" 1 {}
WorldBegin
AttributeBegin AreaLightSource "diffuse" "spectrum L" "stdillum-D65" ReverseOrientation
Translate 0 0 4 Shape "disk" "float radius" 0.2 AttributeEnd
Material "diffuse" "spectrum reflectance" [360 .1 2500 .1]
Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
Material "diffuse" "spectrum reflectance" [360 .8 2500 .8]
Shape "trianglemesh" "point3 P" [-9 2 0  9 2 0  9 2 3  -9 2 3] "integer indices" [0 1 2  0 2 3]
Shape "trianglemesh" "point3 P" [0 -9 2.5  0 9 2.5  -9 9 2.5  -9 -9 2.5] "integer indices" [0 1 2  0 2 3]
)",
                                 integrator),
                     {.samples = samples, .seed = 3});
}

uint64_t rays_of(const Film& film) {
  uint64_t rays = 0;
  for (size_t i = 0; i < film.tiles(); ++i) rays += film.tile(i).rays();
  return rays;
}

// 5 standard errors: a false alarm in 1.7 million.
TEST(Roulette, DoesNotChangeTheMean) {
  const auto never = channel_mean(room("\"float roulette\" 1e6", 256), 1);
  EXPECT_LT(never.error, 0.005 * never.mean) << "the test has lost its power";
  for (const char* roulette : {"", "\"float roulette\" 4", "\"float roulette\" 1", "\"float roulette\" .25"}) {
    const auto found = channel_mean(room(roulette, 256), 1);
    EXPECT_NEAR(found.mean, never.mean, 5 * std::hypot(found.error, never.error)) << roulette;
  }
}

/// Variance of a pixel, mean over the pixels of the shadow, the left half, and of the light.
std::array<double, 2> variances(const Film& film) {
  std::array<double, 2> sums{};
  for (int y = 16; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      if (x < 14 || x >= 18) sums[x < 16 ? 0 : 1] += film.variance(x, y)[1];
  return sums;
}

// The pilot ends paths only where that is not seen: what is in shadow keeps its light from the wall, on which nothing
// depends elsewhere. A roulette of all paths alike makes the shadow noisier.
TEST(Roulette, OfAPilotSavesRaysAndNotThoseOfShadows) {
  const Film never = room("\"float roulette\" 1e6", 256), alike = room("\"float roulette\" 2", 256),
             piloted = room("", 256);
  EXPECT_LT(double(rays_of(piloted)), 0.9 * double(rays_of(never)));
  const auto [shadow, light] = variances(never);
  EXPECT_GT(variances(alike)[0], 2 * shadow) << "the test has lost its power";
  EXPECT_LT(variances(piloted)[0], 1.2 * shadow);
  EXPECT_LT(variances(piloted)[1], 1.2 * light);
}

}  // namespace
}  // namespace frond
