#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/call_benchmarks.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/number_list.h"
#include "cli/progress.h"
#include "cli/specimen_options.h"
#include "core/build_identity.h"
#include "instruments/beam.h"
#include "instruments/bsdf_calls.h"
#include "instruments/given_wavelengths.h"
#include "render/measured_material.h"
#include "render/plugins.h"
#include "report/chart.h"
#include "report/text_output.h"
#include "study/compare/machine.h"

namespace frond {
namespace {

struct BenchOptions : SpecimenOptions {
  std::string angles = "0,45,80", lanes = "1,2,3,4", wavelengths, samples = "1e5", json, plot;
  TimingEffort effort;
};

std::vector<double> angles_of(const BenchOptions& o) {
  const auto angles = parse_numbers("--angles", o.angles);
  for (const double theta : angles)
    if (!(theta >= 0 && theta <= 180) || theta == 90)
      fail({}, "--angles: {} is not from 0 to 180 degrees, or it is 90, where a path meets neither side", theta);
  return angles;
}

/// What each number of lanes carries.
std::vector<GivenWavelengths> wavelengths_of(const BenchOptions& o) {
  const auto nm = o.wavelengths.empty() ? std::vector<double>() : parse_numbers("--wavelengths", o.wavelengths);
  for (const double x : nm)
    if (!(x > 0)) fail({}, "--wavelengths: {} nm is no wavelength", x);
  const int most = nm.empty() ? kLanes : static_cast<int>(std::min<size_t>(nm.size(), kLanes));
  const std::vector<float> given(nm.begin(), nm.end());
  std::vector<GivenWavelengths> strategies;
  for (const double lanes : parse_numbers("--lanes", o.lanes)) {
    const int n = static_cast<int>(lanes);
    if (!(lanes >= 1 && lanes <= most) || lanes != n)
      fail({}, "--lanes: a path carries 1 to {} wavelengths, {} were asked for", most, lanes);
    strategies.emplace_back(nm.empty() ? benchmark_wavelengths(n) : std::vector(given.begin(), given.begin() + n));
  }
  return strategies;
}

/// The materials, each ready for each number of lanes.
class Specimens {
 public:
  Specimens(const BenchOptions& o, ThreadPool& pool, const Log& log)
      : wavelengths_(wavelengths_of(o)), angles_deg_(angles_of(o)), seed_(o.seed) {
    const Registry registry = load_registry(o.plugins);
    const auto cache = cache_directory(o.cache, o.no_cache);
    for (const auto& words : specimen_words(o)) {
      labels_.push_back(fmt::format("{}", fmt::join(words, " ")));
      if (std::ranges::count(labels_, labels_.back()) > 1) fail({}, "{}: the same material twice", labels_.back());
      for (const GivenWavelengths& w : wavelengths_) {
        materials_.push_back(ready_material(words, registry, w, pool, log, cache));
        Arena arena;
        if (!materials_.back()->evaluate(flat_hit(), w.sample(0), arena))
          fail({}, "{}: the material says that it has no surface there: nothing can be measured", labels_.back());
      }
    }
  }

  size_t count() const { return labels_.size(); }
  size_t angles() const { return angles_deg_.size(); }

  /// Numbers of lanes run fastest, then angles, then materials.
  std::vector<TimedHit> hits() const {
    std::vector<TimedHit> all;
    for (size_t m = 0; m < labels_.size(); ++m)
      for (const double theta : angles_deg_)
        for (size_t w = 0; w < wavelengths_.size(); ++w)
          all.push_back({labels_[m],
                         {*materials_[m * wavelengths_.size() + w], wavelengths_[w].sample(0), theta,
                          hash_key(seed_, hash_bytes(labels_[m]))}});
    return all;
  }

 private:
  std::vector<GivenWavelengths> wavelengths_;
  std::vector<double> angles_deg_;
  uint64_t seed_;
  std::vector<std::string> labels_;
  std::vector<std::shared_ptr<Material>> materials_;
};

using Json = nlohmann::ordered_json;

void add(Json& entry, const std::string& name, const Estimate& e) {
  entry[name] = e.mean;
  entry[name + "_se"] = e.standard_error();
}

/// Counters of a benchmark, each with its standard error: what its time has to be multiplied with.
void add_counters(Json& entry, BsdfCall call, const SampleWorth& worth) {
  if (call == BsdfCall::sample) {
    add(entry, "albedo", worth.albedo.mean);
    add(entry, "variance", worth.albedo.variance);
  } else if (call == BsdfCall::hit) {
    add(entry, "sky", worth.sky.mean);
    add(entry, "sky_variance", worth.sky.variance);
    add(entry, "sun", worth.sun.mean);
    add(entry, "sun_variance", worth.sun.variance);
  }
}

/// Google Benchmark's JSON with what frond knows beside it.
std::string bench_json(const std::string& of_times, const BenchOptions& o, std::span<const TimedHit> hits,
                       const std::vector<BenchReading>& readings) {
  Json json = Json::parse(of_times);
  Json& context = json["context"];
  context["frond_version"] = FROND_VERSION;
  context["frond"] = FROND_BUILD_IDENTITY;
  context["machine"] = compare::machine_description();
  context["min_time"] = o.effort.min_time_s;
  context["samples"] = o.samples;
  context["seed"] = o.seed;
  std::map<std::string, std::pair<BsdfCall, const SampleWorth*>> by_name;
  for (size_t i = 0; i < hits.size(); ++i)
    for (const BsdfCall call : {BsdfCall::sample, BsdfCall::hit})
      by_name[hits[i].name(call)] = {call, &readings[i].worth};
  for (Json& entry : json["benchmarks"])
    if (const auto it = by_name.find(entry["name"]); it != by_name.end() && entry["run_type"] == "iteration")
      add_counters(entry, it->second.first, *it->second.second);
  return json.dump(2) + "\n";
}

void warn_where_busy(const Log& log) {
  double load = 0;
  const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  if (getloadavg(&load, 1) == 1 && load > threads)
    log.warn({}, fmt::format("the machine had other work to do: a load of {:.1f} on {} processors", load, threads));
}

void run_bench(const BenchOptions& o) {
  const int64_t samples = parse_count("--samples", o.samples, 1000);
  if (!o.json.empty()) check_text_output(o.json);
  if (!o.plot.empty()) check_chart(o.plot);
  ThreadPool pool(o.threads);
  const ConsoleLog log(o.quiet);
  const Specimens specimens(o, pool, log);
  if (!o.plot.empty()) check_bench_chart(specimens.count(), specimens.angles());
  const std::vector<TimedHit> hits = specimens.hits();
  const CallTimes times = time_calls(hits, o.effort);
  warn_where_busy(log);
  std::vector<BenchReading> readings;
  for (size_t i = 0; i < hits.size(); ++i)
    readings.push_back({hits[i].material, hits[i].hit.theta_deg, hits[i].hit.lambda.count, times.ns[i],
                        measure_worth(hits[i].hit, samples, pool)});
  if (!o.json.empty()) write_text(o.json, bench_json(times.json, o, hits, readings));
  if (!o.plot.empty()) write_chart(o.plot, bench_chart(readings));
  if (o.json != "-" && !o.quiet) write_text("-", bench_text(readings));
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("bench", "Time the calls of a material's BSDF, and tell what its samples are worth.");
  auto o = std::make_shared<BenchOptions>();
  add_specimen_options(*command, *o);
  command->add_option(
      "--angles", o->angles,
      "Of the path's ray from the front's normal, degrees; 0,45,80 by default. Above 90 it meets the back.");
  command->add_option("--lanes", o->lanes, "Numbers of wavelengths that a path carries; 1,2,3,4 by default.");
  command->add_option("--wavelengths", o->wavelengths,
                      "nm; a path of n lanes carries the first n. By default those of frond_bench (docs/bench.md).");
  add_count_option(*command, "--repetitions", o->effort.repetitions, 10000, "Of each benchmark; 5 by default.");
  command->add_option("--min-time", o->effort.min_time_s, "Seconds that a repetition takes at least; 0.01 by default.")
      ->check(is_positive);
  command->add_option("--samples", o->samples, "For the variance of each estimate; 1e5 by default.");
  command->add_option("--json", o->json, "File for Google Benchmark's JSON; - for standard output, in place of text.")
      ->type_name("FILE");
  command->add_option("--plot", o->plot, "Chart of variance against the cost of a hit, .svg or .png.")
      ->type_name("FILE");
  command->callback([o] { run_bench(*o); });
}

}  // namespace frond
