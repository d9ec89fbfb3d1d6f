#include <benchmark/benchmark.h>

#include "bench/scene_study.h"
#include "render/render_loop.h"

/// Leaf models in whole scenes: CPU time of a bundle of samples and error of the image. docs/performance.md defines the
/// counters. Names do not change between releases.
namespace frond {
namespace {

constexpr const char* kBaseline = "abm";

SceneStudy& study_of(const std::string& scene) {
  static std::map<std::string, std::unique_ptr<SceneStudy>> all;
  auto& study = all[scene];
  if (!study) study = std::make_unique<SceneStudy>(scene);
  return *study;
}

/// A render on one thread that adds a bundle of samples per pixel at a time: a render of fewer traces the camera rays
/// of whole packets all the same, and its time says little about renders of many samples.
class Meter {
 public:
  Meter(SceneStudy& study, const std::string& material)
      : scene_(study.scene(material)), film_({.settings = study.film()}), pool_(1) {
    add_bundle();  // allocates memory; not counted
    paths_ = cpu_seconds_ = 0;
  }

  void add_bundle() {
    const RenderStatistics s =
        render(job_of(scene_), plan_of(film_, {samples_, samples_ + PathBundle::kSize}), film_, pool_);
    samples_ += PathBundle::kSize;
    paths_ += double(s.paths), cpu_seconds_ += s.cpu_seconds;
  }
  double seconds_per_path() const { return cpu_seconds_ / paths_; }

 private:
  const Scene& scene_;
  Film film_;
  ThreadPool pool_;
  uint64_t samples_ = 0;
  double paths_ = 0, cpu_seconds_ = 0;
};

/// Sets a counter and its standard error.
void report(benchmark::State& state, const std::string& name, double value, double standard_error) {
  state.counters[name] = value;
  state.counters[name + "_se"] = standard_error;
}

/// Variance × CPU time of a pixel's samples: the inverse of efficiency.
double effort(const Accuracy& accuracy, const Meter& meter) {
  return accuracy.noise.value * double(SceneStudy::kSamples) * meter.seconds_per_path();
}

void report_errors(benchmark::State& state, const Accuracy& accuracy) {
  constexpr std::array<const char*, 3> kNames{"red", "green", "blue"};
  for (size_t c = 0; c < kNames.size(); ++c) {
    const auto& [error, offset] = accuracy.channels[c];
    const std::string channel = std::string("_") + kNames[c];
    report(state, "rms" + channel, error.total.root(), error.total.standard_error / (2 * error.total.root()));
    report(state, "bias2" + channel, error.bias.value, error.bias.standard_error);
    report(state, "offset" + channel, offset.mean, offset.standard_error());
  }
  report(state, "variance", accuracy.noise.value, accuracy.noise.standard_error);
}

/// Renders bundles of both in turn, each as often the first as the second, so that other load affects both equally.
/// Google Benchmark times only `own`.
void render_in_turn(benchmark::State& state, Meter& own, Meter& baseline) {
  bool first = true;
  for (auto _ : state) {
    state.PauseTiming();
    if (!first) baseline.add_bundle();
    state.ResumeTiming();
    own.add_bundle();
    state.PauseTiming();
    if (first) baseline.add_bundle();
    first = !first;
    state.ResumeTiming();
  }
}

struct Candidate {
  std::string material;
  bool is_leaf;  ///< a leaf model, whose error is measured
};

void measure(benchmark::State& state, const std::string& scene, const Candidate& candidate) {
  SceneStudy& study = study_of(scene);
  Meter own(study, candidate.material), baseline(study, kBaseline);
  render_in_turn(state, own, baseline);
  state.counters["us_per_path"] = own.seconds_per_path() * 1e6;
  state.counters["speedup"] = baseline.seconds_per_path() / own.seconds_per_path();
  if (!candidate.is_leaf) return;
  const Accuracy& accuracy = study.accuracy(candidate.material);
  report_errors(state, accuracy);
  const double own_effort = effort(accuracy, own);
  state.counters["efficiency"] = 1 / own_effort;
  state.counters["speedup_equal_noise"] = effort(study.accuracy(kBaseline), baseline) / own_effort;
}

[[maybe_unused]] const bool kAdded = [] {
  for (const char* scene : {"soybean-front", "soybean-back", "soybean-ambient", "hundred-leaves"})
    for (const Candidate& candidate :
         {Candidate{"abm", true}, Candidate{"leaf_simplified", true}, Candidate{"leaf_solved", true},
          Candidate{"leaf_lambert", true}, Candidate{"diffusetransmission", false}}) {
      const std::string name = "scene/" + std::string(scene) + "/" + candidate.material;
      benchmark::RegisterBenchmark(name.c_str(), measure, std::string(scene), candidate)->Unit(benchmark::kMillisecond);
    }
  return true;
}();

}  // namespace
}  // namespace frond
