#include <benchmark/benchmark.h>

#include "core/log.h"
#include "materials/lobes/tabulated_bssrdf.h"
#include "render/plugins.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/overrides.h"
#include "scene/scene.h"

/// Material "subsurface": CPU time of a path by integrator, of a segment and its weight, and of the table. Names do not
/// change between releases.
namespace frond {
namespace {

/// A ball under a sky and a point light.
void path(benchmark::State& state, const std::string& integrator, const std::string& material) {
  ThreadPool pool(1);
  const Registry registry = builtin_registry();
  SceneDescription d = parse_scene_text(
      "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\nFilm \"rgb\" \"integer xresolution\" 32 "
      "\"integer yresolution\" 32\nIntegrator \"" +
          integrator +
          "\"\nWorldBegin\nLightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\nLightSource \"point\" \"point3 "
          "from\" [2 2 2]\nMaterial " +
          material + "\nShape \"sphere\" \"float radius\" 1.5\n",
      "subsurface", silent_log());
  apply_overrides({.wavelengths = "hero"}, d, registry, silent_log());
  const Scene scene(d, registry, pool, silent_log());
  const auto render_all = [&] {
    Film film({.settings = scene.film()});
    return render(job_of(scene), plan_of(film, {0, PathBundle::kSize}), film, pool);
  };
  render_all();  // allocates memory; not counted
  double paths = 0, seconds = 0;
  for (auto _ : state) {
    const RenderStatistics s = render_all();
    paths += double(s.paths), seconds += s.cpu_seconds;
  }
  state.counters["us_per_path"] = seconds / paths * 1e6;
}

void table(benchmark::State& state) {
  const ThreadPool pool(1);
  for (auto _ : state) benchmark::DoNotOptimize(BeamDiffusion(0, 1.33, pool));
}

/// One lane whose mean free path differs from that of the others.
void segment(benchmark::State& state) {
  const BeamDiffusion diffusion(0, 1.33, ThreadPool(1));
  SampledWavelengths lambda{.active = {true, true, true, true}, .count = 4};
  Hit hit;
  hit.ng = {0, 0, 1};
  hit.shading = Frame::around(hit.ng);
  SampledSpectrum sigma_t(10), albedo(0.9f);
  sigma_t[3] = 2;
  const TabulatedBssrdf bssrdf(diffusion, hit, sigma_t, albedo, lambda,
                               InterfaceExitBsdf(1.33f, 0.93f, SampledSpectrum(1)));
  RandomStream rng(1);
  for (auto _ : state)
    if (const auto s = bssrdf.sample(rng.uniform(), {rng.uniform(), rng.uniform()})) {
      hit.p = s->from;
      benchmark::DoNotOptimize(bssrdf.weight(hit));
    }
}

const std::string kSkin = "\"subsurface\" \"string name\" \"Skin1\" \"float scale\" 8";
BENCHMARK_CAPTURE(path, path, "path", kSkin)->Name("subsurface/path")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path, volpath, "volpath", kSkin)->Name("subsurface/volpath")->Unit(benchmark::kMillisecond);
BENCHMARK(table)->Name("subsurface/table")->Unit(benchmark::kMillisecond);
BENCHMARK(segment)->Name("subsurface/segment");

}  // namespace
}  // namespace frond
