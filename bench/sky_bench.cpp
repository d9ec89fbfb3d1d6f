#include <benchmark/benchmark.h>

#include "bench/bundle_render.h"
#include "core/math/random.h"

/// The light `sky`: time of its functions, and CPU time of a path under it relative to the time under a constant sky
/// and a distant light. Names do not change between releases.
namespace frond {
namespace {

constexpr const char* kSky = "WorldBegin\nLightSource \"sky\" \"float elevation\" 60\n";
constexpr const char* kConstantAndDistant =
    "WorldBegin\n"
    "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\" \"float scale\" 0.05\n"
    "LightSource \"distant\" \"point3 from\" [ 0.5 0 0.8660254 ] \"point3 to\" [ 0 0 0 ] \"spectrum L\" "
    "\"stdillum-D65\"\n";

/// The hundred leaves under other lights.
SceneDescription lit(const std::string& material, const std::string& lights) {
  SceneDescription d = BundleRender::described("hundred-leaves/scene.pbrt", material);
  d.lights = parse_scene_text(lights, "lights", silent_log()).lights;
  return d;
}

void path_under_sky(benchmark::State& state, const std::string& material) {
  BundleRender sky(lit(material, kSky)), baseline(lit(material, kConstantAndDistant));
  compare_paths(state, sky, baseline);
}

/// One function of the light, at directions or numbers that vary.
template <class Call>
void call_light(benchmark::State& state, const Call& call) {
  const BundleRender sky(lit("diffusetransmission", kSky));
  const EnvironmentLight& light = *sky.scene().environment()[0];
  const SampledWavelengths lambda = sky.scene().wavelengths().sample(0.5f);
  RandomStream random(1);
  for (auto _ : state) call(light, Vec2{random.uniform(), random.uniform()}, lambda);
}

void sample(benchmark::State& state) {
  call_light(state, [](const EnvironmentLight& light, Vec2 u, const SampledWavelengths& lambda) {
    benchmark::DoNotOptimize(light.sample_compensated({}, u, lambda));
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
