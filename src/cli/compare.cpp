#include <CLI/CLI.hpp>
#include <chrono>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/number_list.h"
#include "cli/progress.h"
#include "cli/reading_options.h"
#include "cli/strict_log.h"
#include "core/log.h"
#include "render/plugins.h"
#include "scene/words.h"
#include "study/choose/choice_report.h"
#include "study/compare/charts.h"
#include "study/compare/machine.h"
#include "study/compare/measure.h"
#include "study/compare/report.h"
#include "study/compare/summary.h"
#include "study/compare/verdict.h"
#include "system/cpu_clock.h"

namespace frond {
namespace {

using compare::Comparison;
using compare::Plan;
using compare::Request;
using compare::StudyOptions;

/// The analog walk's expectation with far less noise.
constexpr const char* kReference = "abm,mode=weighted";
constexpr const char* kCandidates = "abm;abm,mode=weighted;leaf_simplified;leaf_solved;leaf_lambert";

struct CompareOptions {
  std::string scene, output, reference, cache, wavelengths, target;
  std::vector<std::string> materials{kCandidates}, leaves, plugins;
  int size = 0, samples = 0, reference_samples = 0, threads = 0;
  uint64_t seed = 0;
  std::optional<double> exposure;
  std::vector<double> rms;
  ReadingOptions reading;
  bool quick = false, quiet = false, no_cache = false, relative = false, seed_given = false;
};

/// What holds where nothing is said, in a first look and otherwise.
struct Setting {
  int size;
  uint64_t samples, reference_samples;
};
constexpr Setting kQuick{128, 32, 128}, kFull{256, 256, 1024};

Plan plan_of(const CompareOptions& o) {
  const Setting& setting = o.quick ? kQuick : kFull;
  Plan plan{.reference = compare::parse_candidate(o.reference), .candidates = compare::parse_candidates(o.materials)};
  if (plan.candidates.size() > compare::kMostCurves)
    fail({}, "{} candidates are more than the {} that a chart can tell apart", plan.candidates.size(),
         compare::kMostCurves);
  plan.top_samples = o.samples > 0 ? uint64_t(o.samples) : setting.samples;
  plan.reference_samples = o.reference_samples > 0 ? uint64_t(o.reference_samples) : setting.reference_samples;
  plan.cache = cache_directory(o.cache, o.no_cache);
  return plan;
}

/// The paper's three sets by name, or three numbers.
std::array<double, 3> target_of(const std::string& text) {
  if (text == "front") return {0.009, 0.009, 0.012};
  if (text == "back") return {0.011, 0.014, 0.010};
  if (text == "ambient") return {0.020, 0.016, 0.012};
  std::array<double, 3> target{};
  const auto words = split(text, ',');
  for (size_t i = 0; i < 3 && words.size() == 3; ++i) target[i] = finite_number(words[i]).value_or(0);
  if (!(target[0] > 0 && target[1] > 0 && target[2] > 0))
    fail({}, "--target takes the RMS of red, green and blue (0.009,0.009,0.012), or front, back or ambient: \"{}\"",
         text);
  return target;
}

Request request_of(const CompareOptions& o) {
  Request request{.rms = o.rms, .exposure_stops = o.exposure, .relative = o.relative};
  if (!o.target.empty()) request.target = target_of(o.target);
  return request;
}

StudyOptions study_options(const CompareOptions& o, const Plan& plan) {
  StudyOptions s{.scene = o.scene, .wavelengths = o.wavelengths, .leaves = o.leaves, .plugins = o.plugins};
  s.unsupported = unsupported_of(o.reading);
  s.size = o.size > 0 ? o.size : o.quick ? kQuick.size : kFull.size;
  if (o.seed_given) s.seed = o.seed;
  s.cache = plan.cache;
  return s;
}

std::string command_line_of(const CompareOptions& o) {
  std::string line = "frond compare " + o.scene;
  const auto add = [&line](const char* name, const std::string& value) {
    if (!value.empty()) line += fmt::format(" {} \"{}\"", name, value);
  };
  const auto add_number = [&line](const char* name, double value) {
    if (value != 0) line += fmt::format(" {} {:g}", name, value);
  };
  for (const std::string& m : o.materials) add("--materials", m);
  add("--reference", o.reference), add("--wavelengths", o.wavelengths), add("--target", o.target);
  for (const std::string& leaf : o.leaves) add("--leaf", leaf);
  for (const std::string& plugin : o.plugins) add("--plugin", plugin);
  add_number("--size", o.size), add_number("--spp", o.samples), add_number("--reference-spp", o.reference_samples);
  for (const double rms : o.rms) add_number("--rms", rms);
  add_number("--exposure", o.exposure.value_or(0));
  if (o.seed_given) line += fmt::format(" --seed {}", o.seed);
  return line + (o.relative ? " --relative" : "") + (o.quick ? " --quick" : "");
}

std::string scene_name(const std::filesystem::path& scene) {
  const auto folder = scene.parent_path().filename();
  return (folder.empty() ? scene.filename() : folder / scene.filename()).string();
}

/// What `frond render` would choose for leaves that ask for this error; "" where wavelengths have no colours.
std::string leaf_by_leaf(double rms, const std::string& wavelengths, const compare::Study& study, const Plan& plan,
                         ThreadPool& pool, const Log& log) {
  SceneDescription description{study.description(), {}, {}, {}};  // what stands in it stands already
  const PluginText open{"leaf", {{"model", "auto"}, {"maxrms", fmt::format("{}", rms)}}};
  apply_swaps(description, study.swaps_to(open), study.registry(), silent_log());
  SceneOverrides overrides;
  overrides.wavelengths = wavelengths;
  overrides.seed = study.seed();
  overrides.cache_dir = plan.cache;
  const choose::ChoiceTask subject{description,  study.registry(), overrides,
                                   study.film(), plan.top_samples, study.any_scene().get()};
  const auto chosen = choose::choose_models(subject, choose::standard_ladder(study.registry()), pool, silent_log());
  if (!chosen) return {};
  log.info(choose::choice_text(chosen->choice));
  return choose::choice_sentence(chosen->choice);
}

void run_compare(const CompareOptions& o) {
  const auto start = std::chrono::steady_clock::now();
  const ConsoleLog console(o.quiet);
  const StrictLog log(console, o.reading.strict);
  Plan plan = plan_of(o);
  ProgressLine progress(o.quiet);
  plan.progress = &progress;
  const Request request = request_of(o);
  compare::check_report_folder(o.output);
  ThreadPool pool(o.threads);
  const compare::Study study(study_options(o, plan), pool, log);
  if (o.reading.strict) (void)study.scene(plan.reference);  // what it warns of is told before the renders
  log.check();
  Comparison result = compare::measure(study, plan, request, pool, log);
  log.check();
  // The chooser knows absolute errors alone.
  for (const double rms : request.relative ? std::vector<double>{} : request.rms)
    result.leaf_by_leaf +=
        (result.leaf_by_leaf.empty() ? "" : "\n") + leaf_by_leaf(rms, o.wavelengths, study, plan, pool, log);
  result.scene = scene_name(o.scene);
  result.command = command_line_of(o);
  result.machine = compare::machine_description();
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.cpu_seconds = cpu_seconds();
  compare::write_report(o.output, result);
  if (o.quiet) return;
  fmt::print("{}\n{}\n\nThe report is {}\n", compare::summary_text(result), compare::verdict(result),
             (std::filesystem::path(o.output) / "index.html").string());
}

void add_options(CLI::App& command, CompareOptions& o) {
  command.add_option("scene", o.scene, "Scene file.")->type_name("SCENE")->required();
  command.add_option("-o,--output", o.output, "Folder of the report.")->type_name("FOLDER")->required();
  command
      .add_option(
          "--materials", o.materials,
          "Candidates, separated by ; or given again: [LABEL:]MATERIAL[,parameter=value...][@wavelengths=PLUGIN]"
          "[@integrator=PLUGIN]. The first is the baseline of speed-ups.")
      ->allow_extra_args(false)
      ->default_str(kCandidates);
  command.add_option("--reference", o.reference, "Candidate that counts as right, once converged.")
      ->type_name("MATERIAL")
      ->default_val(kReference);
  command.add_option("--rms", o.rms, "Name the cheapest candidate with this RMS error; may be given again.")
      ->check(is_positive)
      ->allow_extra_args(false);
  command.add_option("--target", o.target,
                     "RMS of red, green and blue for speed-up (c): numbers, or front, back, "
                     "ambient for the paper's.");
  command.add_flag("--relative", o.relative,
                   "Errors relative to the reference: of each channel the RMS over pixels divided by the reference's "
                   "mean over these pixels; --rms 0.05 is 5 %. FLIP stays as it is; --target is refused and leaves are "
                   "not chosen for one by one, which is by absolute errors.");
  command.add_option("--leaf", o.leaves, "Material to replace; may be given again. Every leaf by default.")
      ->allow_extra_args(false);
  command.add_option("--wavelengths", o.wavelengths, "In place of the scene's; smpte for the paper's three.")
      ->type_name("WAVELENGTHS");
  command.add_option("--size", o.size, "Pixels of the longer side; 256 by default.")->check(CLI::Range(1, 65536));
  add_count_option(command, "--spp", o.samples, 1 << 24, "Samples per pixel of the last rung; 256 by default.");
  add_count_option(command, "--reference-spp", o.reference_samples, 1 << 30,
                   "Samples per pixel of each of the reference's two renders; 1024 by default, or what is cached.");
  command
      .add_option("--exposure", o.exposure,
                  "Stops by which pictures and FLIP are brightened; by default so that the picture is neither dark nor "
                  "burnt out.")
      ->check(is_within({-20, 20}));
  command.add_option("--threads", o.threads, "Threads; all by default.")->check(CLI::Range(1, 1024));
  add_plugin_option(command, o.plugins);
  add_reading_options(command, o.reading);
  command.add_option("--cache", o.cache, "Folder for references and tables; ~/.cache/frond by default.")
      ->type_name("FOLDER");
  command.add_flag("--no-cache", o.no_cache, "Keep neither references nor tables on disk.");
  command.add_flag("--quick", o.quick, "A first look: 128 pixels, up to 32 samples, a reference of 2 x 128.");
  command.add_flag("-q,--quiet", o.quiet, "Print nothing but errors.");
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto* command = app.add_subcommand("compare", "What each leaf model costs in a scene, and what error it makes.");
  auto options = std::make_shared<CompareOptions>();
  add_options(*command, *options);
  auto* seed = command->add_option("--seed", options->seed, "Seed of all random numbers.")->check(is_seed);
  command->callback([options, seed] {
    options->seed_given = seed->count() > 0;
    run_compare(*options);
  });
}

}  // namespace frond
