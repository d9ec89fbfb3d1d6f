#include <fmt/format.h>

#include <chrono>
#include <list>
#include <ranges>

#include "jobs/record/common_params.h"
#include "jobs/support/shell_command.h"
#include "scene/format/words.h"
#include "scene/leaf_models.h"
#include "study/choose/choice_report.h"
#include "study/compare/measure.h"
#include "study/compare/report/charts.h"
#include "study/compare/report/report.h"
#include "study/compare/report/tables.h"
#include "study/compare/report/verdict.h"
#include "system/file_uses.h"
#include "system/machine.h"

namespace frond {

// `frond compare`: error and cost of leaf models in a scene, against a converged reference (docs/compare.md).

extern const JobInfo kCompareJob;

namespace {

using compare::Comparison;
using compare::Plan;
using compare::Request;
using enum ArgumentKind;

constexpr JobParam kCompareParams[] = {
    kSceneParam,
    JobParam("materials", texts,
             "Candidates, separated by ;: [LABEL:]MATERIAL[,parameter=value...], optionally followed by "
             "@wavelengths=PLUGIN or "
             "@integrator=PLUGIN. The first is the baseline of speed-ups. By default every leaf model, from the most "
             "expensive to the cheapest, and its variant with less noise.",
             {.type = "MATERIAL", .aliases = "models", .decides = true}),
    JobParam("output", text, "Folder of the report: charts, tables, index.html. By default results are only printed.",
             {.type = "FOLDER", .aliases = "o", .path = PathUse::write}),
    JobParam("reference", text,
             "Candidate whose converged render is the reference. The default is the expectation of the analog "
             "random walk, with less noise.",
             {.type = "MATERIAL", .decides = true}),
    JobParam("rms", numbers, "Report the cheapest candidate with this RMS error.",
             {.type = "NUMBER", .range = {1e-6, 1}, .decides = true}),
    JobParam("target", text,
             "RMS errors of red, green and blue for the speed-up at equal error: three numbers, or the paper's front, "
             "back or ambient.",
             {.type = "R,G,B", .decides = true, .excludes = "relative"}),
    JobParam("relative", flag,
             "Report errors relative to the reference: RMS over pixels, divided by the reference's mean over "
             "them, in each channel; --rms 0.05 is 5 %. FLIP stays absolute, and models are not selected leaf by leaf.",
             {.decides = true}),
    JobParam("leaf", texts, "Name of a material to replace; by default every leaf.", {.type = "NAME", .decides = true}),
    JobParam("wavelengths", text, "Wavelength strategy instead of the scene's; smpte: the paper's three wavelengths.",
             {.type = "WAVELENGTHS", .decides = true}),
    JobParam("size", count, "Pixels of the longer side; 256 by default, 128 with --quick.",
             {.range = {1, 65536}, .decides = true}),
    JobParam("spp", count, "Largest number of samples per pixel of a candidate; 256 by default, 32 with --quick.",
             {.range = {1, 1 << 24}, .aliases = "samples", .decides = true}),
    JobParam(
        "reference-spp", count,
        "Samples per pixel of each of the reference's two renders; by default 1024, 128 with --quick, or the number "
        "in the cache.",
        {.range = {1, 1 << 30}, .aliases = "reference-samples", .decides = true}),
    JobParam("exposure", real,
             "Exposure of images and FLIP; by default such that the image is neither dark nor overexposed.",
             {.unit = "stops", .range = {-20, 20}, .decides = true}),
    kSeedParam,
    JobParam("quick", flag, "Preview: 128 pixels, up to 32 samples, a reference of 2 x 128 samples.",
             {.decides = true}),
    kIgnoreUnsupportedParam,
    kStrictParam,
    kCsvParam,
    kJsonParam,
};

/// Default sizes.
struct Setting {
  int64_t size, samples, reference_samples;
};
constexpr Setting kQuick{128, 32, 128}, kFull{256, 256, 1024};

/// Returns --target: a set of the paper by name, or three numbers. Throws InputError.
std::array<double, 3> target_errors(const Arguments& args) {
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

/// Returns --materials, or all leaf models, the most expensive first, each with its variant of less noise.
std::vector<std::string> candidates_of(const JobRun& run) {
  if (run.args.given("materials")) return run.args.texts("materials");
  const auto models = leaf_models(run.session().registry());
  std::vector<std::string> texts;
  for (const MaterialInfo* model : std::views::reverse(models)) {
    texts.emplace_back(model->name);
    if (const std::string quiet = quiet_text(*model); quiet != model->name) texts.push_back(quiet);
  }
  return texts;
}

/// Returns the plan of the arguments, with `setting` as defaults. Throws InputError for too many candidates.
Plan plan_of(const JobRun& run, const Setting& setting) {
  const Arguments& args = run.args;
  const std::string reference =
      args.given("reference") ? args.text("reference") : quiet_text(reference_model(run.session().registry()));
  Plan plan{.reference = compare::parse_candidate(reference),
            .candidates = compare::parse_candidates(candidates_of(run))};
  if (plan.candidates.size() > compare::kMostCurves)
    fail({}, "{} candidates are more than the {} that a chart can tell apart", plan.candidates.size(),
         compare::kMostCurves);
  plan.top_samples = uint64_t(args.given("spp") ? args.count("spp") : setting.samples);
  plan.reference_samples =
      uint64_t(args.given("reference-spp") ? args.count("reference-spp") : setting.reference_samples);
  return plan;
}

/// Returns the last folder and the file name of a scene: file names alone are mostly "scene.pbrt".
std::string scene_name(const std::filesystem::path& scene) {
  const auto folder = scene.parent_path().filename();
  return (folder.empty() ? scene.filename() : folder / scene.filename()).string();
}

/// Stops a study by an exception, because compare::measure takes no stop token.
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

/// Returns a sentence about the models that `frond render` would select for open leaves with this error bound; "" if
/// the wavelengths have no colours.
std::string leaf_by_leaf(const JobRun& run, double rms, const compare::Study& study, const Plan& plan) {
  // Both kinds of error are defined as in the report.
  const std::string limit = run.args.flag("relative") ? "maxrelativerms" : "maxrms";
  SceneDescription description{study.description(), {}, {}, {}};  // without geometry, which the study's scene provides
  const PluginText open{std::string(open_leaf(study.registry()).name),
                        {{"model", "auto"}, {limit, fmt::format("{}", rms)}}};
  apply_overrides({.swaps = study.swaps_to(open), .seed = study.seed()}, description, study.registry(), silent_log());
  const choose::ChoiceTask task{.session = study.session(),
                                .description = description,
                                .samples = plan.top_samples,
                                .other = study.any_scene().get(),
                                .is_question = true};
  const auto chosen = choose::choose_models(task, choose::standard_ladder(study.registry()), silent_log());
  if (!chosen) return {};
  run.log().info(choose::choice_text(chosen->choice));
  return choose::choice_sentence(chosen->choice);
}

/// The job: renders reference and candidates, evaluates the errors, and writes the report.
Result compare_models(const JobRun& run) {
  const Arguments& args = run.args;
  warn_if_nothing_is_kept(run);
  const auto start = std::chrono::steady_clock::now();
  const Setting& setting = args.flag("quick") ? kQuick : kFull;
  Plan plan = plan_of(run, setting);
  Request request{.rms = args.numbers("rms"), .relative = args.flag("relative")};
  if (args.given("exposure")) request.exposure_stops = args.real("exposure");
  if (args.given("target")) request.target = target_errors(args);
  const std::string output = args.text("output");
  std::list<PlannedOutput> report;
  if (!output.empty()) {
    compare::check_report_folder(output);
    for (const std::string& name : compare::report_files())
      report.emplace_back("the report", (std::filesystem::path(output) / name).string());
  }
  compare::StudyOptions options{.scene = args.text("scene"), .wavelengths = wavelengths_text(args)};
  options.leaves = args.texts("leaf");
  options.size = int(args.given("size") ? args.count("size") : setting.size);
  if (args.given("seed")) options.seed = args.seed("seed");
  Session& session = run.session();
  const compare::Study study(session, read_scene(run, scenes_of(run).front()), options);
  if (args.flag("strict")) (void)study.scene(plan.reference);  // strict mode reports warnings before the renders
  run.context.log().check();
  StoppingProgress progress(run);
  plan.progress = &progress;
  Comparison result = compare::measure(study, plan, request);
  for (const double rms : request.rms)
    result.leaf_by_leaf += (result.leaf_by_leaf.empty() ? "" : "\n") + leaf_by_leaf(run, rms, study, plan);
  result.scene = scene_name(args.text("scene"));
  result.command = pasted_command(kCompareJob, args);
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

const JobInfo kCompareJob("compare", "Leaf models", "Measure the cost and the error of each leaf model in a scene.", "",
                          kCompareParams, SessionUse::all, compare_models);

}  // namespace frond
