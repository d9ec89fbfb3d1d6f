#include "radiometry/brf.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "jobs/support/provenance.h"
#include "jobs/support/radiometry.h"
#include "jobs/support/refine.h"
#include "jobs/support/scene_fluorescence.h"
#include "jobs/support/time_limit.h"
#include "radiometry/brf_comparison.h"
#include "render/parts/part_file.h"
#include "report/brf_chart.h"
#include "report/chart.h"
#include "scene/leaf_models.h"
#include "study/compare/candidate.h"
#include "system/machine.h"

namespace frond {

// `frond brf`: bidirectional reflectance factor of a scene for a distant sensor, or a comparison of leaf models by it
// (docs/radiometry.md).

namespace {

using enum ArgumentKind;

constexpr JobParam kBrfParams[] = {
    kSceneParam,
    kRadiometryWavelengthsParam,
    JobParam("zenith", numbers,
             "Zenith angles of the views; negative angles are on the sun's side, if there is one sun.",
             {.default_value = "-75:75:5", .unit = "degrees", .decides = true, .quantity = PhysicalQuantity::angle}),
    JobParam("azimuth", numbers,
             "Azimuths of the views from the sun's plane; from +x toward +y if there is not exactly one sun.",
             {.default_value = "0", .unit = "degrees", .decides = true}),
    JobParam("hemisphere", flag, "Views of the whole hemisphere, every 5 degrees of zenith and 15 of azimuth.",
             {.decides = true, .excludes = "zenith,azimuth"}),
    kTargetParam,
    kPeriodParam,
    JobParam(
        "paths", count,
        "Number of paths for each view, rounded up to a multiple of 128; at least 128 for each wavelength are traced.",
        {.default_value = "65536", .range = {1, 4294967296}}),
    rms_param(
        "Relative standard error (0.01 is 1 % of the BRF): stop when the RMS over all views and wavelengths is below "
        "this; --paths is then not used."),
    kTimeLimitParam,
    scene_fluorescence_param(
        "Measure the radiance of fluorescence instead, and the share of it that escapes from the canopy.",
        "wavelengths,compare,part,merge"),
    kSceneEmissionParam,
    kSwapParam,
    kIntegratorParam,
    kSeedParam,
    JobParam("compare", texts,
             "MODEL[,parameter=value...];...: replace the scene's leaves by each model and report which are accurate "
             "enough.",
             {.type = "MATERIAL", .excludes = "plot,checkpoint,resume,part,merge"}),
    JobParam("reference", text, "Reference leaf model of --compare; by default the exact model without noise.",
             {.type = "MATERIAL", .needs = "compare"}),
    JobParam("within", real, "Largest relative difference at which --compare calls a model accurate enough.",
             {.default_value = "0.02", .range = kAboveZero, .needs = "compare"}),
    kIgnoreUnsupportedParam,
    kStrictParam,
    kCsvParam,
    kJsonParam,
    kProvenanceParam,
    chart_param("plot", "Chart against the zenith angle, or maps of a hemisphere: .svg or .png."),
    part_param("csv,json,plot,rms"),
    kPathRangeParam,
    merge_param("part,rms,time-limit,checkpoint,resume"),
    kCheckpointParam,
    kResumeParam,
};

/// Returns the views: --zenith x --azimuth, or a hemisphere in rings of 5 degrees up to 85.
std::vector<ViewDirection> views_of(const Arguments& args) {
  std::vector<ViewDirection> views;
  if (args.flag("hemisphere")) {
    constexpr int kZenithStep = 5, kLast = 85, kAzimuthStep = 15;
    views.push_back({0, 0});
    for (int zenith = kZenithStep; zenith <= kLast; zenith += kZenithStep)
      for (int azimuth = 0; azimuth < 360; azimuth += kAzimuthStep) views.push_back({double(zenith), double(azimuth)});
    return views;
  }
  for (const double azimuth : args.numbers("azimuth"))
    for (const double zenith : args.numbers("zenith")) {
      if (!(std::abs(zenith) < 90))
        fail({}, "{}: {:g} is not above the horizon, which is at 90", args.spelled("zenith"), zenith);
      views.push_back({zenith, azimuth});
    }
  return views;
}

/// Returns an empty part, or the partial result of an earlier run. Throws InputError if that result is of another
/// measurement.
RenderPart first_part(const JobRun& run, const BrfMeter& meter, const ResumeFile* resume_file) {
  RenderPart fresh = meter.scene().empty_part();
  const auto path = resume_file ? resume_file->found(run.args.flag("resume")) : std::nullopt;
  if (!path) return fresh;
  RenderPart part = read_part(*path);
  const std::string difference =
      fresh.header.identity.difference(part.header.identity, "this command", "\"" + path->string() + "\"");
  if (!difference.empty()) fail({}, "{}: this is another measurement. {}", run.args.spelled("resume"), difference);
  return part;
}

/// Returns the sum of --merge, of this number of samples. Throws InputError for samples that no part has, that two
/// parts have, or a part of another measurement.
RenderPart merged_parts(const JobRun& run, const BrfMeter& meter, uint64_t samples) {
  const auto files = run.args.texts("merge");
  RenderPart sum = merge_parts({files.begin(), files.end()});
  const std::string difference = meter.scene().empty_part().header.identity.difference(
      sum.header.identity, "this command", '"' + files.front() + '"');
  if (!difference.empty()) fail({}, "\"{}\" is a part of another measurement. {}", files.front(), difference);
  if (std::string missing = missing_samples_text(sum); !missing.empty() || sample_count(sum.film).most != samples) {
    if (missing.empty()) missing = fmt::format("samples {}:{}", sample_count(sum.film).most, samples);
    fail({}, "no part has {} (a sample is {} paths of each view)", missing, BrfMeter::kRows);
  }
  return sum;
}

/// Returns nullopt if the measurement was stopped. `resume_file` may be nullptr.
std::optional<BrfMeasurement> measure(const JobRun& run, RenderControl control, const BrfMeter& meter,
                                      const ResumeFile* resume_file) {
  // A refinement starts with few samples; each band needs at least one sample.
  constexpr uint64_t kFirst = 8;
  const uint64_t needed = meter.scene().scene().wavelengths().bands().size();
  const bool refines = run.args.given("rms"), compares = run.args.given("compare");
  const auto paths = uint64_t(run.args.count("paths"));
  const RefineLimits limits{
      .amount = std::max(refines ? kFirst : (paths + BrfMeter::kRows - 1) / BrfMeter::kRows, needed),
      .most = uint64_t{1} << 32,
      .target_error = run.args.real("rms"),
      .predicts = true};
  if (run.args.given("merge")) return meter.read(merged_parts(run, meter, limits.amount).film, compares);
  RenderPart part = first_part(run, meter, resume_file);
  std::optional<Checkpointer> checkpointer;
  if (resume_file) {
    checkpointer.emplace(resume_file->checkpoint(), checkpoint_seconds(run.args), part, control.progress, run.log());
    control.progress = &*checkpointer;
  }
  // The next amount follows from an error that an interrupted run no longer knows: the part states it.
  const auto request = [&](uint64_t samples) {
    const auto change = [&] { part.header.request = samples; };
    checkpointer ? checkpointer->change_part(change, part.header) : change();
  };
  const bool writes_part = run.args.given("part");
  const auto write = [&part](const auto& path) { write_part(path, part.header, part.film); };
  SampleRange range{0, limits.amount};
  if (writes_part) {
    range = path_range_of(run.args, BrfMeter::kRows, limits.amount * BrfMeter::kRows);
    range = {range.begin / BrfMeter::kRows, range.end / BrfMeter::kRows};
  }
  std::optional<BrfMeasurement> measurement;
  const RefineEnd end = refine(
      limits, std::max(part.header.request, sample_count(part.film).most), control,
      [&](uint64_t samples) {
        if (!writes_part) range.end = samples;
        if (refines) request(samples);
        if (!range.empty()) run.session().render(meter.scene(), range, part, control);
      },
      [&] { return measurement.emplace(meter.read(part.film, compares)).relative_error(); });
  checkpointer.reset();
  if (resume_file) resume_file->keep(end != RefineEnd::stopped, writes_part, write);
  if (end == RefineEnd::stopped || writes_part) return {};
  if (end == RefineEnd::time_over && sample_count(part.film).least == 0)
    fail(scene_file(run.args), "{}: the time limit ended before every direction was measured",
         run.args.spelled("time-limit"));
  return meter.read(part.film, compares);
}

/// Returns the column of the quantity: "brf" or "hdrf".
std::string column_of(const BrfMeasurement& measurement) { return measurement.quantity == "BRF" ? "brf" : "hdrf"; }

/// Appends one row for each view and band. `model` may be empty.
void add_rows(Table& table, const BrfMeasurement& measurement, const std::string& model) {
  for (size_t view = 0; view < measurement.views.size(); ++view)
    for (size_t band = 0; band < measurement.bands.size(); ++band) {
      if (!model.empty()) table.add("model", model);
      table.add("zenith_deg", measurement.views[view].zenith_deg);
      table.add("azimuth_deg", measurement.views[view].azimuth_deg);
      add_band(table, measurement.bands[band]);
      table.add(column_of(measurement), measurement.at(view, band));
    }
}

/// Table with one row for each direction and one column for each band.
Table direction_table(const BrfMeasurement& measurement) {
  Table table{"brf"};
  for (size_t view = 0; view < measurement.views.size(); ++view) {
    table.add("zenith", measurement.views[view].zenith_deg);
    table.add("azimuth", measurement.views[view].azimuth_deg);
    for (size_t band = 0; band < measurement.bands.size(); ++band)
      table.add(heading_of(measurement.bands[band]), measurement.at(view, band));
  }
  return table;
}

/// BRF of the scene with one leaf model, and the model's cost.
struct ModelMeasurement {
  compare::Candidate model;
  BrfMeasurement brf;
  double cpu_us_per_path = 0;
};

Result comparison_result(const ModelMeasurement& reference, const std::vector<ModelMeasurement>& models,
                         double within) {
  using Answer = BrfVerdict::Answer;
  Table differences{"brf"}, verdicts{"models"};
  const auto add = [&](const ModelMeasurement& m) {
    add_rows(differences, m.brf, m.model.label);
    for (const MeanError& d : relative_to(reference.brf, m.brf)) differences.add("relative_difference", d);
  };
  add(reference);
  const ModelMeasurement* enough = nullptr;
  for (const ModelMeasurement& m : models) {
    add(m);
    const BrfVerdict v = check_agreement(reference.brf, m.brf, within);
    verdicts.add("model", m.model.label);
    verdicts.add("us_per_path", m.cpu_us_per_path);
    verdicts.add("worst_difference", v.worst);
    verdicts.add("zenith_deg", m.brf.views[v.view].zenith_deg);
    add_band(verdicts, m.brf.bands[v.band]);
    verdicts.add("upper_bound", v.upper);
    verdicts.add("enough", std::string(v.answer == Answer::enough       ? "yes"
                                       : v.answer == Answer::not_enough ? "no"
                                       : m.brf.has_heavy_tails          ? "unknown: its noise is unbounded"
                                                                        : "unknown: more paths are needed"));
    if (v.answer == Answer::enough && !enough) enough = &m;
  }
  const std::string& cheapest = (enough ? *enough : reference).model.label;
  return {
      .tables = {differences, verdicts},
      .facts = {{"quantity", std::string(reference.brf.quantity)},
                {"reference", reference.model.label},
                {"within", within},
                {"cheapest_enough", cheapest}},
      .text = fmt::format("{} relative to {} ({:.2f} µs of CPU per path); accurate enough: within {:g} % everywhere\n"
                          "{}Cheapest model that is accurate enough: {}\n",
                          reference.brf.quantity, reference.model.label, reference.cpu_us_per_path, 100 * within,
                          to_text(verdicts), cheapest)};
}

/// Measures the scene once with each leaf model in place of its leaves. Models share the geometry of the first.
Result run_comparison(const JobRun& run, const BrfRequest& request) {
  const SceneDescription description = described_scene(run);
  std::unique_ptr<BrfMeter> first;
  const auto measured = [&](const compare::Candidate& model) {
    if (!model.wavelengths.empty() || model.integrator)
      fail({}, "{} takes materials without @wavelengths or @integrator: \"{}\"", run.args.spelled("compare"),
           model.text);
    SceneDescription with_model = description;
    apply_overrides({.swaps = {{"*", model.material}}}, with_model, run.session().registry(), run.log());
    const RenderControl control = run.control_until(run.args.real("time-limit"));  // of each model
    const auto load = [&] {
      return std::make_unique<BrfMeter>(run.session(), std::move(with_model), request,
                                        first ? &first->scene().scene() : nullptr);
    };
    auto meter = within_time_limit(run, control, load, [&run] { return scene_file(run.args); });
    run.context.log().check();
    const double start = cpu_seconds();
    auto measurement = measure(run, control, *meter, nullptr);
    if (!measurement) throw Stopped();
    warn_of_time_limit(run, measurement->paths, measurement->relative_error());
    ModelMeasurement result{model, *std::move(measurement)};
    const double paths = double(result.brf.paths) * double(result.brf.views.size());
    result.cpu_us_per_path = (cpu_seconds() - start) * 1e6 / paths;
    if (!first) first = std::move(meter);
    return result;
  };
  const auto models = compare::parse_candidates(run.args.texts("compare"));
  const std::string exact = run.args.given("reference") ? run.args.text("reference")
                                                        : std::string(noiseless_model(run.session().registry()).name);
  const ModelMeasurement reference = measured(compare::parse_candidate(exact));
  std::vector<ModelMeasurement> measurements;
  for (const compare::Candidate& model : models) measurements.push_back(measured(model));
  // Sorted by cost, so that the first sufficient model is the cheapest.
  std::ranges::sort(measurements, {}, &ModelMeasurement::cpu_us_per_path);
  return comparison_result(reference, measurements, run.args.real("within"));
}

/// The job: measures the scene as it is, or with the leaf models of --compare.
Result brf(const JobRun& run) {
  check_chart_param(run, "plot");
  warn_if_nothing_is_kept(run);
  const bool is_fluorescence = run.args.flag("fluorescence");
  const BrfRequest request{.views = views_of(run.args),
                           .target = target_of(run.args),
                           .period = period_of(run.args),
                           .wavelengths = is_fluorescence ? emission_text(run.args) : wavelengths_text(run.args),
                           .keeps_depth = run.args.given("integrator"),
                           .fluorescence = is_fluorescence};
  if (run.args.given("compare")) return run_comparison(run, request);
  std::optional<ResumeFile> resume_file;
  if (const auto names = kept_names_of(run.args)) resume_file.emplace(*names, run.control.stop, run.log());
  const RenderControl control = run.control_until(run.args.real("time-limit"));
  Location where = scene_file(run.args);
  const auto load = [&] {
    SceneDescription description = described_scene(run);
    if (description.integrator.where.file) where = description.integrator.where;
    return std::make_unique<const BrfMeter>(run.session(), std::move(description), request);
  };
  const auto meter = within_time_limit(run, control, load, [&where] { return where; });
  run.context.log().check();
  const auto measured = measure(run, control, *meter, resume_file ? &*resume_file : nullptr);
  if (!measured) {  // stopped, or --part has been written
    const bool stopped = run.control.stop.stop_requested();
    if (resume_file && stopped) resume_file->report_stop();
    return {.stopped = stopped};
  }
  const BrfMeasurement& measurement = *measured;
  if (run.args.given("plot"))
    write_chart(run.args.text("plot"),
                run.args.flag("hemisphere") ? brf_hemisphere_chart(measurement) : brf_plane_chart(measurement));
  const double error = measurement.relative_error();
  run.log().info(
      fmt::format("{} paths for each view; RMS relative standard error {:.2f} %", measurement.paths, 100 * error));
  warn_of_time_limit(run, measurement.paths, error);
  if (is_fluorescence) return fluorescence_brf_result(run, *meter, measurement, control);
  Result result{.tables = {{"brf"}},
                .facts = {{"quantity", std::string(measurement.quantity)},
                          {"paths", double(measurement.paths)},
                          {"relative_error", error}}};
  for (Fact& fact : scene_provenance(meter->scene().scene(), meter->scene().description()))
    result.facts.push_back(std::move(fact));
  add_rows(result.tables[0], measurement, "");
  result.text = fmt::format("{}\n{}", measurement.quantity, to_text(direction_table(measurement)));
  return result;
}

}  // namespace

extern const JobInfo kBrfJob("brf", "Measure", "Measure the bidirectional reflectance factor of a scene from far away.",
                             "Under more than one sun, as with a sky, the result is the hemispherical-directional "
                             "reflectance factor (HDRF). Leaves without \"incident\" use incident=reciprocal, or "
                             "incident=light if their model is "
                             "a random walk.",
                             kBrfParams, SessionUse::all, brf);

}  // namespace frond
