#include "core/camera_samples.h"

#include <gtest/gtest.h>

#include "render/plugins.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/scene.h"

namespace frond {
namespace {

/// Film of 8 x 4 pixels, with a lens; `options` and the camera's transform come first.
std::unique_ptr<Scene> scene_of(const std::string& options, const std::string& world, ThreadPool& pool) {
  const std::string text = options +
                           "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 4\n"
                           "Camera \"perspective\" \"float fov\" 40 \"float lensradius\" .1 \"float focaldistance\" 4\n"
                           "WorldBegin\n" +
                           world;
  return std::make_unique<Scene>(parse_scene_text(text, "test.pbrt", silent_log()), builtin_registry(), pool,
                                 silent_log());
}

const std::string kMovingCamera = "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All ";

TEST(CameraSamples, DoNotDependOnWhichSamplesAreWanted) {
  ThreadPool pool(1);
  const auto scene = scene_of(kMovingCamera, "LightSource \"infinite\"", pool);
  const CameraSampling sampling = scene->camera_sampling();
  CameraSamples all(sampling, &scene->filter()), one(sampling, &scene->filter());
  all.make({3, 2}, 32, 0xffff);
  std::array<bool, 2> differs{};  // lens and time vary
  for (size_t i = 0; i < PathBundle::kSize; ++i) {
    one.make({3, 2}, 32, 1u << i);
    const Ray &a = all.bundle().rays[i], &b = one.bundle().rays[i];
    EXPECT_EQ(a.o, b.o);
    EXPECT_EQ(a.d, b.d);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(all.bundle().lambda[i].nm, one.bundle().lambda[i].nm);
    EXPECT_EQ(all.bundle().keys[i], one.bundle().keys[i]);
    EXPECT_EQ(all.position(i).offset.x, one.position(i).offset.x);
    EXPECT_EQ(one.bundle().lanes, i < RayPacket::kWidth ? 0x00ffu : 0xff00u);
    differs[0] |= a.o.z != all.bundle().rays[0].o.z || a.o.y != all.bundle().rays[0].o.y;
    differs[1] |= a.time != all.bundle().rays[0].time;
  }
  EXPECT_TRUE(differs[0]);
  EXPECT_TRUE(differs[1]);
}

TEST(CameraSamples, WithoutJitterAreAtTheCentresOfPixelAndLens) {
  ThreadPool pool(1);
  const auto scene = scene_of("Option \"bool disablepixeljitter\" true Option \"bool disablewavelengthjitter\" true ",
                              "LightSource \"infinite\"", pool);
  const CameraSampling sampling = scene->camera_sampling();
  CameraSamples samples(sampling, &scene->filter());
  samples.make({3, 2}, 0, 0xffff);
  const Ray centre = scene->camera().ray({3.5f, 2.5f}, {0.5f, 0.5f});
  for (size_t i = 0; i < PathBundle::kSize; ++i) {
    EXPECT_EQ(samples.bundle().rays[i].o, centre.o);
    EXPECT_EQ(samples.bundle().rays[i].d, centre.d);
    EXPECT_EQ(samples.bundle().lambda[i].nm, samples.bundle().lambda[0].nm);
    EXPECT_EQ(samples.position(i).weight, 1);
  }
}

// At time 0 the light is out of view: only paths with times of their own hit it.
TEST(FilmExponent, UsesTheTimesOfTheRender) {
  ThreadPool pool(1);
  const std::string light =
      "AreaLightSource \"diffuse\" \"float scale\" 64 \"bool twosided\" true Shape \"trianglemesh\" "
      "\"point3 P\" [-9 -9 4 9 -9 4 9 9 4 -9 9 4] \"integer indices\" [0 1 2 0 2 3]";
  const std::string away = "Translate 100 0 0 ",
                    past = "ActiveTransform EndTime Translate -200 0 0 ActiveTransform All ";
  EXPECT_EQ(film_exponent(job_of(*scene_of(away, light, pool)), 1), 0);  // black
  EXPECT_GT(film_exponent(job_of(*scene_of(away + past, light, pool)), 1), 0);
}

}  // namespace
}  // namespace frond
