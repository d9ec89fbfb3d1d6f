#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::rays_of;
using test::render_text;
using ::testing::HasSubstr;

/// A dark floor under a lamp, the left half of it in the shadow of a roof, and a bright wall behind it.
Film room(const std::string& integrator, uint64_t seed = 1, int samples = 128) {
  return render_text(fmt::format(R"(
LookAt 0 -2 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 50 "integer lightsamples" 1 {}
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
                     {.samples = samples, .seed = seed});
}

const std::string kNever = "\"float roulette\" 1e6";

// 5 standard errors in each of eight comparisons: a false alarm in 200,000.
TEST(Roulette, DoesNotChangeTheMean) {
  for (const std::string rays : {" \"integer scatteredrays\" 1", " \"integer scatteredrays\" 2"}) {
    const auto never = channel_mean(room(kNever + rays), 1);
    EXPECT_LT(never.error, 0.008 * never.mean) << "the test has lost its power";
    uint64_t seed = 1;
    for (const std::string roulette : {"", "\"float roulette\" 4", "\"float roulette\" 1", "\"float roulette\" .25"}) {
      const auto found = channel_mean(room(roulette + rays, ++seed), 1);
      EXPECT_NEAR(found.mean, never.mean, 5 * std::hypot(found.error, never.error)) << roulette << rays;
    }
  }
}

/// Sums of the pixels' variances in the shadow, the left side of the lower half, and in the light.
std::array<double, 2> variances(const Film& film) {
  std::array<double, 2> sums{};
  for (int y = 16; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      if (x < 14 || x >= 18) sums[x < 16 ? 0 : 1] += film.variance(x, y)[1];
  return sums;
}

// The pilot ends paths where that is not seen: in a shadow nearly all paths go on to the wall, its only light.
TEST(Roulette, OfAPilotSavesRaysAndFewOfShadows) {
  const Film never = room(kNever), alike = room("\"float roulette\" 2"), piloted = room("");
  const auto [shadow, light] = variances(never);
  // Measured with 256 samples: 0.67 of the rays; variances of 4.6 (alike), 1.26 and 1.01 times those without roulette.
  EXPECT_LT(double(rays_of(piloted)), 0.8 * double(rays_of(never)));
  EXPECT_GT(variances(alike)[0], 3 * shadow) << "the test has lost its power";
  EXPECT_LT(variances(piloted)[0], 1.6 * shadow);
  EXPECT_LT(variances(piloted)[1], 1.2 * light);
}

TEST(Roulette, ItsParametersAreNamedWhereTheyHaveNoEffect) {
  const auto said = [](const std::string& parameters) {
    const ConsoleLog log(true);
    ThreadPool pool(1);
    const SceneDescription description =
        parse_scene_text("Integrator \"path\" " + parameters + "\nWorldBegin\nLightSource \"infinite\"", "s", log);
    ::testing::internal::CaptureStderr();
    const Scene scene(description, make_registry(builtin_materials(), builtin_integrators()), pool, log);
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(said("\"float cutoff\" 0.1"),
              HasSubstr("\"cutoff\" has no effect without \"termination\" \"attenuation\""));
  EXPECT_THAT(said("\"string termination\" \"attenuation\" \"float roulette\" 2"),
              HasSubstr("\"roulette\" has no effect without \"termination\" \"roulette\""));
  EXPECT_EQ(said("\"string termination\" \"attenuation\" \"float cutoff\" 0.1"), "");
  EXPECT_EQ(said("\"float roulette\" 2"), "");
}

}  // namespace
}  // namespace frond
