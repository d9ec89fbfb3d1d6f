#pragma once

#include "core/log.h"
#include "render/plugins.h"
#include "render/render_loop.h"
#include "scene/format/parser.h"
#include "scene/overrides.h"
#include "scene/scene.h"

namespace frond {

/// A scene that is rendered on one thread, a bundle of 16 samples for each pixel at a time.
class BundleRender {
 public:
  explicit BundleRender(SceneDescription description)
      : pool_(1),
        registry_(builtin_registry()),
        scene_(description, registry_, pool_, silent_log()),
        film_({.settings = scene_.film()}) {
    add_bundle();  // allocates memory; not counted
    paths_ = cpu_seconds_ = 0;
  }

  /// Reads a scene of the repository, with `material` for all leaves, in hero wavelengths.
  static SceneDescription described(const std::string& file, const std::string& material) {
    SceneDescription d = parse_scene(std::string(FROND_SOURCE_DIR "/scenes/") + file, silent_log());
    apply_overrides({.swaps = {{"leaf", {material, {}}}}, .wavelengths = "hero"}, d, builtin_registry(), silent_log());
    return d;
  }

  void add_bundle() {
    const WorkPlan plan = plan_of(film_, {samples_, samples_ + PathBundle::kSize});
    const RenderStatistics s = render(job_of(scene_), plan, film_, pool_);
    samples_ += PathBundle::kSize;
    paths_ += double(s.paths), cpu_seconds_ += s.cpu_seconds;
  }
  double seconds_per_path() const { return cpu_seconds_ / paths_; }
  const Scene& scene() const { return scene_; }

 private:
  ThreadPool pool_;
  Registry registry_;
  Scene scene_;
  Film film_;
  uint64_t samples_ = 0;
  double paths_ = 0, cpu_seconds_ = 0;
};

/// Renders both in turn, so that other load affects both equally. Sets the counters us_per_path, of the first, and
/// `cost`: its time of a path relative to the second's.
inline void compare_paths(benchmark::State& state, BundleRender& render, BundleRender& baseline) {
  for (auto _ : state) {
    render.add_bundle();
    state.PauseTiming();
    baseline.add_bundle();
    state.ResumeTiming();
  }
  state.counters["us_per_path"] = render.seconds_per_path() * 1e6;
  state.counters["cost"] = render.seconds_per_path() / baseline.seconds_per_path();
}

}  // namespace frond
