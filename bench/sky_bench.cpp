#include <benchmark/benchmark.h>

#include "core/log.h"
#include "core/random.h"
#include "render/plugins.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/overrides.h"
#include "scene/scene.h"

/// The light `sky`: time of its functions, and CPU time of a path under it relative to that under a constant sky and a
/// distant light. Names do not change between releases.
namespace frond {
namespace {

constexpr const char* kSky = "WorldBegin\nLightSource \"sky\" \"float elevation\" 60\n";
constexpr const char* kConstantAndDistant =
    "WorldBegin\n"
    "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\" \"float scale\" 0.05\n"
    "LightSource \"distant\" \"point3 from\" [ 0.5 0 0.8660254 ] \"point3 to\" [ 0 0 0 ] \"spectrum L\" "
    "\"stdillum-D65\"\n";

/// A scene of the repository under other lights, rendered on one thread by bundles of 16 samples a pixel.
class Lit {
 public:
  Lit(const std::string& file, const std::string& material, const std::string& lights)
      : pool_(1),
        registry_(builtin_registry()),
        scene_(described(file, material, lights), registry_, pool_, silent_log()),
        film_({.settings = scene_.film()}) {
    add_bundle();  // allocates memory; not counted
    paths_ = cpu_seconds_ = 0;
  }
  void add_bundle() {
    const RenderJob job{scene_,          scene_.camera(),  scene_.integrator(), scene_.wavelengths(),
                        scene_.filter(), scene_.sampler(), scene_.seed()};
    const WorkPlan plan = plan_of(film_, {samples_, samples_ + PathBundle::kMost});
    const RenderStatistics s = render(job, plan, film_, pool_);
    samples_ += PathBundle::kMost;
    paths_ += double(s.paths), cpu_seconds_ += s.cpu_seconds;
  }
  double seconds_per_path() const { return cpu_seconds_ / paths_; }
  const Scene& scene() const { return scene_; }

 private:
  SceneDescription described(const std::string& file, const std::string& material, const std::string& lights) const {
    SceneDescription d = parse_scene(std::string(FROND_SOURCE_DIR "/scenes/") + file, silent_log());
    d.lights = parse_scene_text(lights, "lights", silent_log()).lights;
    apply_overrides({.swaps = {{"leaf", {material, {}}}}, .wavelengths = "hero"}, d, registry_, silent_log());
    return d;
  }

  ThreadPool pool_;
  Registry registry_;
  Scene scene_;
  Film film_;
  uint64_t samples_ = 0;
  double paths_ = 0, cpu_seconds_ = 0;
};

/// Renders under both in turn, so that other load affects both equally. `cost`: time of a path relative to that under
/// the constant sky and the distant light.
void path_under_sky(benchmark::State& state, const std::string& material) {
  Lit sky("hundred-leaves/scene.pbrt", material, kSky);
  Lit baseline("hundred-leaves/scene.pbrt", material, kConstantAndDistant);
  for (auto _ : state) {
    sky.add_bundle();
    state.PauseTiming();
    baseline.add_bundle();
    state.ResumeTiming();
  }
  state.counters["us_per_path"] = sky.seconds_per_path() * 1e6;
  state.counters["cost"] = sky.seconds_per_path() / baseline.seconds_per_path();
}

/// One function of the light, at directions or numbers that vary.
template <class Call>
void call_light(benchmark::State& state, const Call& call) {
  const Lit sky("hundred-leaves/scene.pbrt", "diffusetransmission", kSky);
  const EnvironmentLight& light = *sky.scene().environment()[0];
  const SampledWavelengths lambda = sky.scene().wavelengths().sample(0.5f);
  RandomStream random(1);
  for (auto _ : state) call(light, Vec2{random.uniform(), random.uniform()}, lambda);
}

void sample(benchmark::State& state) {
  call_light(state, [](const EnvironmentLight& light, Vec2 u, const SampledWavelengths& lambda) {
    benchmark::DoNotOptimize(light.sample_competing({}, u, lambda));
  });
}

void radiance(benchmark::State& state) {
  call_light(state, [](const EnvironmentLight& light, Vec2 u, const SampledWavelengths& lambda) {
    const float r = std::sqrt(1 - u.x * u.x);
    benchmark::DoNotOptimize(light.radiance({}, {r * (1 - 2 * u.y), r * std::sqrt(4 * u.y * (1 - u.y)), u.x}, lambda));
  });
}

BENCHMARK_CAPTURE(path_under_sky, diffusetransmission, "diffusetransmission")
    ->Iterations(6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path_under_sky, leaf_lambert, "leaf_lambert")->Iterations(6)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path_under_sky, leaf_solved, "leaf_solved")->Iterations(6)->Unit(benchmark::kMillisecond);
BENCHMARK(sample)->Name("light/sky/sample");
BENCHMARK(radiance)->Name("light/sky/radiance");

}  // namespace
}  // namespace frond
