#include "jobs/support/call_benchmarks.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"

#ifdef FROND_HAS_BENCHMARK
#include <benchmark/benchmark.h>

#include <map>
#include <sstream>

#include "instruments/beam.h"
#include "instruments/bsdf_calls.h"
#endif

namespace frond {

std::string TimedHit::name(BsdfCall call) const {
  return fmt::format("bsdf/{}/{}/theta:{:.6g}/wavelengths:{}", material, kBsdfCalls[static_cast<size_t>(call)],
                     hit.theta_deg, hit.lambda.count);
}

#ifdef FROND_HAS_BENCHMARK

namespace {

/// Reporter that collects Google Benchmark's JSON output and the CPU times of all repetitions.
class Recorder final : public benchmark::BenchmarkReporter {
 public:
  Recorder() {
    json_.SetOutputStream(&text_);
    json_.SetErrorStream(&text_);
  }
  bool ReportContext(const Context& context) override { return json_.ReportContext(context); }
  void ReportRuns(const std::vector<Run>& runs) override {
    json_.ReportRuns(runs);
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration) times_[run.benchmark_name()].add(run.GetAdjustedCPUTime());
  }
  void Finalize() override { json_.Finalize(); }

  Estimate time_ns(const std::string& name) const { return times_.at(name).estimate(); }
  std::string json() const { return text_.str(); }

 private:
  std::ostringstream text_;
  benchmark::JSONReporter json_;
  std::map<std::string, Moments> times_;
};

/// Registers a benchmark of call(bsdf, wo, draw, rng) on one BSDF.
template <class Call>
void add_call(const TimedHit& timed, BsdfCall which, const Call& call) {
  benchmark::RegisterBenchmark(timed.name(which).c_str(), [&timed, call](benchmark::State& state) {
    check_stop();
    const Vec3 wo = view_direction(timed.hit.theta_deg);
    Arena arena;
    const Bsdf& bsdf = *timed.hit.material.evaluate(flat_hit(), timed.hit.lambda, arena);
    CallDraws draws;
    RandomStream rng(2);
    for (auto _ : state) benchmark::DoNotOptimize(call(bsdf, wo, draws.next(), rng));
  });
}

/// Registers the benchmark of a complete hit: the BSDF is created in every iteration.
void add_hit(const TimedHit& timed) {
  benchmark::RegisterBenchmark(timed.name(BsdfCall::hit).c_str(), [&timed](benchmark::State& state) {
    check_stop();
    const Vec3 wo = view_direction(timed.hit.theta_deg);
    const Hit hit = flat_hit();
    Arena arena;
    CallDraws draws;
    RandomStream rng(2);
    for (auto _ : state) {
      const CallDraws::Draw& draw = draws.next();
      arena.reset();
      const Bsdf* bsdf = timed.hit.material.evaluate(hit, timed.hit.lambda, arena);
      benchmark::DoNotOptimize(path_vertex(*bsdf, wo, draw.wi, draw.uc, draw.u, rng));
    }
  });
}

/// Registers the benchmarks of all calls of a hit, in the order of BsdfCall.
void add_all(const TimedHit& timed) {
  add_call(timed, BsdfCall::sample,
           [](const Bsdf& bsdf, const Vec3& wo, const CallDraws::Draw& draw, RandomStream& rng) {
             return bsdf.sample(wo, draw.uc, draw.u, rng);
           });
  add_call(timed, BsdfCall::f, [](const Bsdf& bsdf, const Vec3& wo, const CallDraws::Draw& draw, RandomStream& rng) {
    return bsdf.f(wo, draw.wi, rng);
  });
  add_call(timed, BsdfCall::pdf, [](const Bsdf& bsdf, const Vec3& wo, const CallDraws::Draw& draw, RandomStream&) {
    return bsdf.pdf(wo, draw.wi);
  });
  add_hit(timed);
}

/// Configures Google Benchmark, which takes its settings only from a command line. All settings are always passed,
/// because it keeps values of an earlier call.
void set(const TimingEffort& effort) {
  static char program[] = "frond";
  std::string repetitions = fmt::format("--benchmark_repetitions={}", effort.repetitions),
              min_time = fmt::format("--benchmark_min_time={}", effort.min_time_s),
              mixed = "--benchmark_enable_random_interleaving=true";
  std::array<char*, 5> words{program, repetitions.data(), min_time.data(), mixed.data(), nullptr};
  int count = static_cast<int>(words.size()) - 1;
  benchmark::Initialize(&count, words.data());
}

}  // namespace

/// Benchmarks are registered globally in Google Benchmark, and cleared afterwards.
CallTimes time_calls(std::span<const TimedHit> hits, const TimingEffort& effort) {
  set(effort);
  for (const TimedHit& hit : hits) add_all(hit);
  Recorder recorder;
  const struct Clear {
    ~Clear() { benchmark::ClearRegisteredBenchmarks(); }
  } clear;  // also if a benchmark throws Stopped
  benchmark::RunSpecifiedBenchmarks(&recorder, ".");
  CallTimes times{.ns = {}, .json = recorder.json()};
  for (const TimedHit& hit : hits) {
    auto& ns = times.ns.emplace_back();
    for (size_t call = 0; call < ns.size(); ++call) ns[call] = recorder.time_ns(hit.name(static_cast<BsdfCall>(call)));
  }
  return times;
}

#else

CallTimes time_calls(std::span<const TimedHit>, const TimingEffort&) {
  fail({}, "this frond was built without Google Benchmark (Debian: libbenchmark-dev), which frond bench requires");
}

#endif

}  // namespace frond
