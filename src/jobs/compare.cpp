#include <fmt/format.h>

#include <chrono>

#include "jobs/record/common_params.h"
#include "scene/format/words.h"
#include "study/choose/choice_report.h"
#include "study/compare/measure.h"
#include "study/compare/report/charts.h"
#include "study/compare/report/report.h"
#include "study/compare/report/tables.h"
#include "study/compare/report/verdict.h"
#include "system/machine.h"

namespace frond {

extern const JobInfo kCompareJob;

namespace {

using compare::Comparison;
using compare::Plan;
using compare::Request;
using enum ArgumentKind;

constexpr JobParam kParams[] = {
    kSceneParam,
    JobParam(
        "materials", texts,
        "Candidates, separated by ; or given again: [LABEL:]MATERIAL[,parameter=value...], with @wavelengths=PLUGIN or "
        "@integrator=PLUGIN behind it. The first is the baseline of speed-ups.",
        {.type = "MATERIAL",
         .default_value = "abm;abm,mode=weighted;leaf_simplified;leaf_solved;leaf_lambert",
         .aliases = "models",
         .decides = true}),
    JobParam("output", text, "Folder of the report: charts, tables, index.html. Without it results are printed alone.",
             {.type = "FOLDER", .aliases = "o", .path = PathUse::write}),
    JobParam("reference", text,
             "Candidate that errors are measured against, once converged. The default is the expectation of the analog "
             "walk, with less noise.",
             {.type = "MATERIAL", .default_value = "abm,mode=weighted", .decides = true}),
    JobParam("rms", numbers, "Report the cheapest candidate with this RMS error.",
             {.type = "NUMBER", .range = kAboveZero, .decides = true}),
    JobParam(
        "target", text,
        "RMS errors of red, green and blue for speed-up (c): three numbers, or front, back, ambient for the paper's.",
        {.type = "R,G,B", .decides = true, .excludes = "relative"}),
    JobParam(
        "relative", flag,
        "Errors relative to the reference: of each channel the RMS over pixels divided by the reference's mean over "
        "these pixels; --rms 0.05 is 5 %. FLIP stays absolute, and models are not selected leaf by leaf.",
        {.decides = true}),
    JobParam("leaf", texts, "Name of a material to replace; by default every leaf.", {.type = "NAME", .decides = true}),
    JobParam("wavelengths", text, "Wavelengths in place of the scene's; smpte for the paper's three.",
             {.type = "WAVELENGTHS", .decides = true}),
    JobParam("size", count, "Pixels of the longer side; 256 by default, 128 with --quick.",
             {.range = {1, 65536}, .decides = true}),
    JobParam("spp", count, "Samples per pixel of the last measurement of a candidate; 256 by default, 32 with --quick.",
             {.range = {1, 1 << 24}, .aliases = "samples", .decides = true}),
    JobParam(
        "reference-spp", count,
        "Samples per pixel of each of the reference's two renders; 1024 by default, 128 with --quick, or the number "
        "that is cached.",
        {.range = {1, 1 << 30}, .aliases = "reference-samples", .decides = true}),
    JobParam("exposure", real,
             "LitMaterial of images and FLIP; by default such that the image is neither dark nor overexposed.",
             {.unit = "stops", .range = {-20, 20}, .decides = true}),
    kSeedParam,
    JobParam("quick", flag, "Preview: 128 pixels, up to 32 samples, a reference of 2 x 128 samples.",
             {.decides = true}),
    kIgnoreUnsupportedParam,
    kStrictParam,
    kCsvParam,
    kJsonParam,
};

/// Sizes where the arguments give none.
struct Setting {
  int64_t size, samples, reference_samples;
};
constexpr Setting kQuick{128, 32, 128}, kFull{256, 256, 1024};

/// The paper's three sets by name, or three numbers.
std::array<double, 3> target_of(const Arguments& args) {
  const std::string text = args.text("target");
  if (text == "front") return {0.009, 0.009, 0.012};
  if (text == "back") return {0.011, 0.014, 0.010};
  if (text == "ambient") return {0.020, 0.016, 0.012};
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 3 || !(std::ranges::min(*numbers) > 0))
    fail({}, "{} takes the RMS of red, green and blue (0.009,0.009,0.012), or front, back or ambient: \"{}\"",
         args.spelled("target"), text);
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

Plan plan_of(const JobRun& run, const Setting& setting) {
  const Arguments& args = run.args;
  Plan plan{.reference = compare::parse_candidate(args.text("reference")),
            .candidates = compare::parse_candidates(args.texts("materials"))};
  if (plan.candidates.size() > compare::kMostCurves)
    fail({}, "{} candidates are more than the {} that a chart can tell apart", plan.candidates.size(),
         compare::kMostCurves);
  plan.top_samples = uint64_t(args.given("spp") ? args.count("spp") : setting.samples);
  plan.reference_samples =
      uint64_t(args.given("reference-spp") ? args.count("reference-spp") : setting.reference_samples);
  return plan;
}

std::string scene_name(const std::filesystem::path& scene) {
  const auto folder = scene.parent_path().filename();
  return (folder.empty() ? scene.filename() : folder / scene.filename()).string();
}

/// Ends a study, which takes no stop token, by an exception.
class StoppingProgress final : public Progress {
 public:
  explicit StoppingProgress(const JobRun& run) : run_(run) {}
  void update(double fraction, const RenderStatistics& so_far) override {
    run_.check_stop();
    if (run_.control.progress) run_.control.progress->update(fraction, so_far);
  }
  void finish() override {
    if (run_.control.progress) run_.control.progress->finish();
  }

 private:
  const JobRun& run_;
};

/// What `frond render` would select for leaves that ask for this error; "" where wavelengths have no colours.
std::string leaf_by_leaf(const JobRun& run, double rms, const compare::Study& study, const Plan& plan) {
  SceneDescription description{study.description(), {}, {}, {}};  // the geometry is the study's
  const PluginText open{"leaf", {{"model", "auto"}, {"maxrms", fmt::format("{}", rms)}}};
  apply_overrides({.swaps = study.swaps_to(open), .seed = study.seed()}, description, study.registry(), silent_log());
  const choose::ChoiceTask task{study.session(), description, plan.top_samples, study.any_scene().get()};
  const auto chosen = choose::choose_models(task, choose::standard_ladder(study.registry()), silent_log());
  if (!chosen) return {};
  run.log().info(choose::choice_text(chosen->choice));
  return choose::choice_sentence(chosen->choice);
}

Result compare_models(const JobRun& run) {
  const Arguments& args = run.args;
  const auto start = std::chrono::steady_clock::now();
  const Setting& setting = args.flag("quick") ? kQuick : kFull;
  Plan plan = plan_of(run, setting);
  Request request{.rms = args.numbers("rms"), .relative = args.flag("relative")};
  if (args.given("exposure")) request.exposure_stops = args.real("exposure");
  if (args.given("target")) request.target = target_of(args);
  const std::string output = args.text("output");
  if (!output.empty()) compare::check_report_folder(output);
  compare::StudyOptions options{.scene = args.text("scene"), .wavelengths = wavelengths_text(args)};
  options.leaves = args.texts("leaf");
  options.unsupported = unsupported_of(args);
  options.size = int(args.given("size") ? args.count("size") : setting.size);
  if (args.given("seed")) options.seed = args.seed("seed");
  Session& session = run.session();
  const compare::Study study(session, options);
  if (args.flag("strict")) (void)study.scene(plan.reference);  // its warnings come before the renders
  run.context.log().check();
  StoppingProgress progress(run);
  plan.progress = &progress;
  Comparison result = compare::measure(study, plan, request);
  // The chooser knows absolute errors alone.
  for (const double rms : request.relative ? std::vector<double>{} : request.rms)
    result.leaf_by_leaf += (result.leaf_by_leaf.empty() ? "" : "\n") + leaf_by_leaf(run, rms, study, plan);
  result.scene = scene_name(args.text("scene"));
  result.command = identifying_command(kCompareJob, args);
  result.machine = machine_description();
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.cpu_seconds = cpu_seconds();
  compare::ComparisonData data = compare::data_of(result);
  std::string text = fmt::format("{}\n{}\n", compare::summary_text(result), compare::verdict(result));
  if (!output.empty()) {
    compare::write_report(output, result, data);
    text += fmt::format("\nThe report is {}\n", (std::filesystem::path(output) / "index.html").string());
  }
  return {
      .tables = std::move(data.tables), .facts = std::move(data.facts), .notes = std::move(data.notes), .text = text};
}

}  // namespace

const JobInfo kCompareJob("compare", "Leaf models",
                          "Measure what each leaf model costs in a scene, and what error it makes.", "", kParams,
                          SessionUse::all, compare_models);

}  // namespace frond
