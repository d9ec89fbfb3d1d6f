#include <benchmark/benchmark.h>

#include "core/log.h"
#include "core/math/random.h"
#include "render/plugins.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/overrides.h"
#include "scene/scene.h"

/// Media: time of a look-up and of the majorants along a ray, and CPU time of a path of `volpath` in each. Names do not
/// change between releases.
namespace frond {
namespace {

constexpr std::string_view kBox = " \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] ";

std::string homogeneous() { return "\"string type\" \"homogeneous\" \"float sigma_a\" .2 \"float sigma_s\" 2"; }
std::string cloud() {
  return fmt::format("\"string type\" \"cloud\" {} \"float sigma_a\" .5 \"float sigma_s\" 5", kBox);
}
/// A grid of 16 values along each axis, random, two thirds of them 0.
std::string grid(std::string_view type, std::string_view name, int channels) {
  std::string values;
  RandomStream rng(1);
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    const float value = rng.uniform() < 2 / 3.f ? 0 : 5 * rng.uniform();
    for (int c = 0; c < channels; ++c) values += fmt::format(" {}", value * (1 - 0.2f * float(c)));
  }
  return fmt::format(
      "\"string type\" \"{}\" \"integer nx\" 16 \"integer ny\" 16 \"integer nz\" 16 {} \"{} {}\" [{}] \"float scale\" "
      "1",
      type, kBox, channels == 3 ? "rgb" : "float", name, values);
}
std::string uniform_grid() { return grid("uniformgrid", "density", 1); }
std::string rgb_grid() { return grid("rgbgrid", "sigma_s", 3); }
std::string nanovdb() {
  return "\"string type\" \"nanovdb\" \"string filename\" \"" FROND_SOURCE_DIR
         "/tests/pbrt_reference/torus.nvdb\" \"float sigma_a\" .5 \"float sigma_s\" 5";
}

/// A ball of the medium under a sky and a point light.
class Ball {
 public:
  explicit Ball(const std::string& medium)
      : pool_(1), registry_(builtin_registry()), scene_(described(medium), registry_, pool_, silent_log()) {}
  RenderStatistics render_all() {
    Film film({.settings = scene_.film()});
    return render(job_of(scene_), plan_of(film, {0, PathBundle::kSize}), film, pool_);
  }
  const Medium& medium() const { return *scene_.medium_interfaces()[0].inside; }
  SampledWavelengths lambda() const { return scene_.wavelengths().sample(0.5f); }

 private:
  SceneDescription described(const std::string& medium) const {
    SceneDescription d = parse_scene_text(
        "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\nFilm \"rgb\" \"integer xresolution\" 32 "
        "\"integer yresolution\" 32\nIntegrator \"volpath\" \"integer maxdepth\" 20\nWorldBegin\n"
        "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\nLightSource \"point\" \"point3 from\" [2 2 2]\n"
        "MakeNamedMedium \"m\" " +
            medium + "\nMaterial \"interface\" MediumInterface \"m\" \"\"\nShape \"sphere\" \"float radius\" 1.5\n",
        "media", silent_log());
    apply_overrides({.wavelengths = "hero"}, d, registry_, silent_log());
    return d;
  }

  ThreadPool pool_;
  Registry registry_;
  Scene scene_;
};

void path(benchmark::State& state, std::string (*medium)()) {
  Ball ball(medium());
  ball.render_all();  // allocates memory; not counted
  double paths = 0, seconds = 0;
  for (auto _ : state) {
    const RenderStatistics s = ball.render_all();
    paths += double(s.paths), seconds += s.cpu_seconds;
  }
  state.counters["us_per_path"] = seconds / paths * 1e6;
}

void at(benchmark::State& state, std::string (*medium)()) {
  const Ball ball(medium());
  const SampledWavelengths lambda = ball.lambda();
  RandomStream rng(1);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        ball.medium().properties(Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * 2 + Vec3{-1, -1, -1}, lambda));
}

void along(benchmark::State& state, std::string (*medium)()) {
  const Ball ball(medium());
  const SampledWavelengths lambda = ball.lambda();
  RandomStream rng(1);
  for (auto _ : state) {
    const Vec3 d = normalize(Vec3{rng.uniform() - 0.5f, rng.uniform() - 0.5f, 1});
    MajorantSteps steps = ball.medium().majorants({d * -3.f, d, 6}, lambda);
    MajorantSteps::Step step;
    while (steps.next(step)) benchmark::DoNotOptimize(step);
  }
}

#define FROND_MEDIUM(name, medium)                                                                     \
  BENCHMARK_CAPTURE(path, name, medium)->Name("medium/" #name "/path")->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(at, name, medium)->Name("medium/" #name "/at");                                    \
  BENCHMARK_CAPTURE(along, name, medium)->Name("medium/" #name "/along")
FROND_MEDIUM(homogeneous, homogeneous);
FROND_MEDIUM(uniformgrid, uniform_grid);
FROND_MEDIUM(rgbgrid, rgb_grid);
FROND_MEDIUM(cloud, cloud);
FROND_MEDIUM(nanovdb, nanovdb);

}  // namespace
}  // namespace frond
