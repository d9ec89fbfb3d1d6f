#include "study/paired_films.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/log.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene_options.h"

namespace frond {
namespace {

constexpr int kSize = 4;

/// Lamps with black surfaces side by side, every second one twice as bright, several in each pixel.
std::string stripes(const std::string& options) {
  std::string text = fmt::format(R"(
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" {0} "integer yresolution" {0}
{1}
WorldBegin
Material "diffuse" "rgb reflectance" [0 0 0]
)",
                                 kSize, options);
  for (int i = 0; i < 20; ++i) {
    const double left = i * 0.1 - 1, right = left + 0.1;
    text += fmt::format("AreaLightSource \"diffuse\" \"float scale\" {}\n", i % 2 + 1);
    text += fmt::format("Shape \"bilinearmesh\" \"point3 P\" [{0} -1 0  {1} -1 0  {0} 1 0  {1} 1 0]\n", left, right);
  }
  return text;
}

/// Sum over both films' pixels of the variance.
double variance(const std::string& options) {
  SceneDescription description = parse_scene_text(stripes(options), "test.pbrt", silent_log());
  set_wavelengths(description, "smpte");
  const Registry registry = make_registry(builtin_materials(), builtin_integrators());
  ThreadPool pool(1);
  const Scene scene(description, registry, pool, silent_log());
  PairedFilms films(scene.film(), film_exponent(job_of(scene), scene.film().exposure), {1, 2}, description, registry,
                    scene);
  films.advance_to(16, scene, pool, nullptr);
  double sum = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (const size_t half : {0u, 1u}) {
        EXPECT_GT(films.film(half).mean(x, y)[0], 0);
        sum += films.film(half).variance(x, y)[0];
      }
  return sum;
}

TEST(PairedFilms, FollowTheOptionsOfTheScene) {
  EXPECT_GT(variance(""), 0);
  EXPECT_EQ(variance("Option \"bool disablepixeljitter\" true"), 0);
}

}  // namespace
}  // namespace frond
