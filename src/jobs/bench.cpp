#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "instruments/beam.h"
#include "instruments/bsdf_calls.h"
#include "instruments/given_wavelengths.h"
#include "jobs/record/common_params.h"
#include "jobs/support/call_benchmarks.h"
#include "render/measured_material.h"
#include "report/chart.h"
#include "system/machine.h"

namespace frond {

// `frond bench`: cost and variance of a BSDF's calls. Google Benchmark times the calls; variances are estimated
// separately, so that timing loops contain nothing else (docs/performance.md).

namespace {

using enum ArgumentKind;

constexpr JobParam kBenchParams[] = {
    kMaterialParam,
    kWithParam,
    JobParam("angles", numbers, "Angles of the path's ray from the front's normal; above 90 it meets the back.",
             {.default_value = "0,45,80", .unit = "degrees", .range = {0, 180}, .aliases = "angle"}),
    JobParam("lanes", numbers, "Numbers of wavelengths that a path carries.",
             {.default_value = "1,2,3,4", .range = {1, kLanes}}),
    JobParam("wavelengths", numbers,
             "Wavelengths; a path of n lanes carries the first n. By default the wavelengths of frond_bench "
             "(docs/performance.md).",
             {.unit = "nm", .range = kAboveZero, .aliases = "wavelength"}),
    JobParam("repetitions", count, "Number of repetitions of each benchmark.",
             {.default_value = "5", .range = {1, 10000}}),
    JobParam("min-time", real, "Minimum duration of a repetition.",
             {.default_value = "0.01", .unit = "s", .range = {kAboveZero.min, 1}}),
    JobParam("samples", count, "Number of samples for the variance of each estimate.",
             {.default_value = "1e5", .range = {1000, kCounts.max}}),
    kSeedParam,
    kCsvParam,
    JobParam("json", text, "File for Google Benchmark's JSON with frond's counters; - is standard output.",
             {.type = "FILE", .path = PathUse::write}),
    chart_param("plot", "Chart of the CPU time to a standard error of 1 %: .svg or .png."),
};

/// Returns --angles. Throws InputError for 90 degrees, at which a ray hits neither side.
std::vector<double> bench_angles(const Arguments& args) {
  const auto angles = args.numbers("angles");
  if (std::ranges::count(angles, 90) > 0)
    fail({}, "{}: at 90 degrees a path meets neither side", args.spelled("angles"));
  return angles;
}

/// Returns one strategy for each entry of --lanes. Without --wavelengths, the wavelengths of frond_bench are used.
std::vector<GivenWavelengths> bench_wavelengths(const Arguments& args) {
  const auto nm = args.numbers("wavelengths");
  const double most = nm.empty() ? kLanes : std::min(double(nm.size()), double(kLanes));
  const std::vector<float> given(nm.begin(), nm.end());
  std::vector<GivenWavelengths> strategies;
  for (const double lanes : args.numbers("lanes")) {
    if (lanes > most || lanes != std::floor(lanes))
      fail({}, "{}: a path carries 1 to {} wavelengths, {} were given", args.spelled("lanes"), most, lanes);
    const int n = int(lanes);
    strategies.emplace_back(nm.empty() ? benchmark_wavelengths(n) : std::vector(given.begin(), given.begin() + n));
  }
  return strategies;
}

/// The materials under test. Each is prepared once for every number of lanes.
class TimedMaterials {
 public:
  explicit TimedMaterials(const JobRun& run)
      : wavelengths_(bench_wavelengths(run.args)), angles_deg_(bench_angles(run.args)), seed_(run.args.seed("seed")) {
    for (const std::string& text : materials_of(run)) {
      if (std::ranges::count(labels_, text) > 0) fail({}, "{}: the same material twice", text);
      labels_.push_back(text);
      for (const GivenWavelengths& w : wavelengths_) {
        materials_.push_back(prepared_material(text, run.session().registry(), w, run.session().pool(), run.log(),
                                               run.context.options().cache));
        Arena arena;
        if (!materials_.back()->evaluate(flat_hit(), w.sample(0), arena))
          fail({}, "{}: the material has no surface there (an alpha of 0, for one): it cannot be measured", text);
      }
    }
  }

  size_t count() const { return labels_.size(); }
  size_t angles() const { return angles_deg_.size(); }

  /// Returns the hits to time. Numbers of lanes vary fastest, then angles, then materials.
  std::vector<TimedHit> hits() const {
    std::vector<TimedHit> all;
    for (size_t m = 0; m < labels_.size(); ++m)
      for (const double theta : angles_deg_)
        for (size_t w = 0; w < wavelengths_.size(); ++w)
          all.push_back({labels_[m],
                         {*materials_[m * wavelengths_.size() + w], wavelengths_[w].sample(0), theta,
                          hash_key(seed_, material_seed(labels_[m]))}});
    return all;
  }

 private:
  std::vector<GivenWavelengths> wavelengths_;
  std::vector<double> angles_deg_;
  uint64_t seed_;
  std::vector<std::string> labels_;
  std::vector<std::shared_ptr<Material>> materials_;
};

/// An estimator of one sample, its expectation and relative variance, and the call whose time the variance is
/// multiplied by.
struct NamedWorth {
  const char* name;
  Worth SampleWorth::*worth;
  BsdfCall call;
  const char* variance;  ///< counter's name in Google Benchmark's JSON
};
constexpr NamedWorth kWorths[] = {{"albedo", &SampleWorth::albedo, BsdfCall::sample, "variance"},
                                  {"sky", &SampleWorth::sky, BsdfCall::hit, "sky_variance"},
                                  {"sun", &SampleWorth::sun, BsdfCall::hit, "sun_variance"}};

/// Columns that identify a measurement, common to both tables.
void add_row_head(Table& table, const BenchMeasurement& r) {
  table.add("material", r.material);
  table.add("theta_deg", r.theta_deg);
  table.add("wavelengths", r.lanes);
}

/// CPU time of each call in ns, one row for each measurement.
Table times_table(const std::vector<BenchMeasurement>& measurements) {
  Table table{"times"};
  for (const BenchMeasurement& r : measurements) {
    add_row_head(table, r);
    for (size_t call = 0; call < kBsdfCalls.size(); ++call)
      table.add(fmt::format("{}_ns", kBsdfCalls[call]), r.time_ns[call].mean, r.time_ns[call].standard_error());
  }
  return table;
}

/// Table of expectations and variances. A variance below the rounding error of floats is reported as exactly 0.
Table worths_table(const std::vector<BenchMeasurement>& measurements) {
  constexpr double kRounding = 1e-12;  // rounding error of floats in the variance
  Table table{"worths"};
  for (const BenchMeasurement& r : measurements) {
    add_row_head(table, r);
    for (const NamedWorth& w : kWorths) {
      const Worth& worth = r.worth.*w.worth;
      const bool is_exact = worth.variance.mean < kRounding;
      const double variance = is_exact ? 0 : worth.variance.mean;
      const std::string name = w.name;
      table.add(name, worth.mean.mean, worth.mean.standard_error());
      table.add(name + "_variance", variance, is_exact ? 0 : worth.variance.standard_error());
      table.add(name + "_us", us_to_percent(worth, variance, r.time(w.call)));
    }
  }
  for (Column& c : table.columns) c.only_data = c.name.ends_with("_variance_se");
  return table;
}

using Json = nlohmann::ordered_json;

/// Returns Google Benchmark's JSON with frond's counters added to each benchmark's iterations.
std::string json_of(const std::string& of_times, const Arguments& args, std::span<const TimedHit> hits,
                    const std::vector<BenchMeasurement>& measurements) {
  Json json = Json::parse(of_times);
  Json& context = json["context"];
  context["frond_version"] = FROND_VERSION;
  context["frond"] = "frond " FROND_VERSION;
  context["machine"] = machine_description();
  context["min_time"] = args.real("min-time");
  context["samples"] = args.count("samples");
  context["seed"] = args.seed("seed");
  std::map<std::string, Json> counters;
  const auto add = [](Json& entry, const std::string& name, const Estimate& e) {
    entry[name] = e.mean;
    entry[name + "_se"] = e.standard_error();
  };
  for (size_t i = 0; i < hits.size(); ++i)
    for (const NamedWorth& w : kWorths) {
      Json& entry = counters[hits[i].name(w.call)];
      add(entry, w.name, (measurements[i].worth.*w.worth).mean);
      add(entry, w.variance, (measurements[i].worth.*w.worth).variance);
    }
  for (Json& entry : json["benchmarks"])
    if (const auto found = counters.find(entry["name"]); found != counters.end() && entry["run_type"] == "iteration")
      entry.update(found->second);
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

/// Timings are unreliable when other processes use the processors.
void warn_if_busy(const Log& log) {
  double load = 0;
  const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  if (getloadavg(&load, 1) == 1 && load > threads)
    log.warn({}, fmt::format("the machine is busy: load average {:.1f} on {} processors", load, threads));
}

/// Times all materials first, on one thread, and estimates their variances afterwards on all threads.
Result bench(const JobRun& run) {
  check_chart_param(run, "plot");
  warn_if_nothing_is_kept(run);
  const TimedMaterials materials(run);
  if (run.args.given("plot")) check_bench_chart(materials.count(), materials.angles());
  const std::vector<TimedHit> hits = materials.hits();
  const CallTimes times = time_calls(hits, {int(run.args.count("repetitions")), run.args.real("min-time")});
  warn_if_busy(run.log());
  std::vector<BenchMeasurement> measurements;
  for (size_t i = 0; i < hits.size(); ++i) {
    run.check_stop();
    measurements.push_back({hits[i].material, hits[i].hit.theta_deg, hits[i].hit.lambda.count, times.ns[i],
                            measure_worth(hits[i].hit, run.args.count("samples"), run.session().pool())});
  }
  if (run.args.given("plot")) write_chart(run.args.text("plot"), bench_chart(measurements));
  const Table time = times_table(measurements), worth = worths_table(measurements);
  return {.tables = {time, worth},
          .text = fmt::format("CPU time of a call, ns\n{}\nExpectation and variance of one-sample estimates; us: CPU "
                              "time in microseconds to a standard error of 1 %\n{}",
                              to_text(time), to_text(worth)),
          .json = json_of(times.json, run.args, hits, measurements)};
}

}  // namespace

extern const JobInfo kBenchJob("bench", "Materials",
                               "Time the calls of a material's BSDF, and measure the variance of its samples.", "",
                               kBenchParams, SessionUse::all, bench);

}  // namespace frond
