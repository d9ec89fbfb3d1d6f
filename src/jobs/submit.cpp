#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "core/error.h"
#include "image/image_file.h"
#include "jobs/submit/engine.h"
#include "jobs/support/render_task.h"
#include "jobs/support/shell_command.h"
#include "scene/format/words.h"
#include "system/atomic_file.h"
#include "system/child_process.h"
#include "system/file_bytes.h"
#include "system/new_files.h"

namespace frond {

// `frond submit` and `frond submit-JOB`: a job of tasks, each with a range of samples or paths, and a merge of their
// parts, for one of several engines (docs/many_machines.md).

extern const JobInfo kFluxJob, kBrfJob;

namespace {

namespace fs = std::filesystem;
using enum ArgumentKind;

/// Returns the names of all engines: "slurm", "openjd", ...
std::vector<std::string_view> engine_names() {
  std::vector<std::string_view> names;
  for (const Engine& engine : engines()) names.push_back(engine.name);
  return names;
}

const std::vector<std::string_view> kEngineNames = engine_names();

constexpr JobParam kScene("scene", text, "Scene file.",
                          {.type = "SCENE", .path = PathUse::read, .positional = true, .required = true});
const JobParam kEngine("engine", text, "Program that schedules the tasks: Slurm, Open Job Description, or Snakemake.",
                       {.choices = kEngineNames});
constexpr JobParam kTasks("tasks", count, "Number of tasks, among which the samples or paths are divided.",
                          {.range = {1, 1e6}, .required = true}),
    kSlurm("slurm", flag, "The same as --engine slurm.", {.excludes = "engine"}),
    kRun("run", flag,
         "Also start the job: submit it with sbatch, or run it here with openjd or snakemake, whose output --quiet "
         "writes to FOLDER/ENGINE.log."),
    kFolder("folder", text, "Folder of the job's files, parts and logs; OUTPUT.ENGINE by default.",
            {.type = "FOLDER", .path = PathUse::write});

/// Parameters of submit itself; JobInfo::extends adds those of the divided job.
const JobParam kSubmitParams[] = {
    kScene,
    JobParam("output", text, "Image that the merge writes.",
             {.type = "FILE", .aliases = "o,outfile", .path = PathUse::write, .required = true}),
    JobParam("spp", count, "Number of samples per pixel.", {.range = {1, 1 << 30}, .required = true}),
    kTasks,
    kEngine,
    kSlurm,
    kRun,
    kFolder,
};
/// The same of a measurement, whose outputs the merge writes.
const JobParam kParamsOfMeasurements[] = {
    kScene,
    JobParam("paths", count, "Number of paths, as of the measurement: in total, or for each view.",
             {.range = kCounts, .required = true}),
    kTasks,
    kEngine,
    kSlurm,
    kRun,
    kFolder,
};

/// Parameters that each task sets itself.
constexpr std::string_view kSetByTasks[] = {"part",       "samples", "checkpoint", "resume",
                                            "time-limit", "threads", "pilot",      "merge"};

/// A job that submit divides.
struct Divided {
  const JobInfo& job;
  std::string_view amount;              ///< parameter whose number is divided
  std::span<const JobParam> of_submit;  ///< parameters of submit, which are not passed on
  bool is_render() const { return &job == &kRenderJob; }
};

/// Returns the frond program that tasks run: this executable, or from Python the one on the tasks' PATH.
std::string program() {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  return self.filename().string().starts_with("python") ? "frond" : self.string();
}

/// Whether a parameter names a file that the divided job writes.
bool is_output(const JobParam& p) { return p.path == PathUse::write && p.type == "FILE"; }

/// Returns the parameters that are passed on to the divided job: its own, except those that submit or the tasks set.
/// Throws InputError for a parameter that a part, or a part of the paths, excludes.
std::vector<const JobParam*> forwarded_params(const JobRun& run, const Divided& divided) {
  std::vector<const JobParam*> params;
  std::string excluded;
  for (const JobParam* p : params_of(divided.job))
    if (p->name == "part" || p->name == "samples") excluded += fmt::format(",{}", p->excludes);
  for (const JobParam* p : params_of(divided.job)) {
    const bool is_set = std::ranges::find(divided.of_submit, p->name, &JobParam::name) != divided.of_submit.end();
    const bool by_task = std::ranges::count(kSetByTasks, p->name) > 0;
    if (by_task && run.args.given(p->name)) fail({}, "{} is set by each task", run.args.spelled(p->name));
    const auto in = [](const auto& names, std::string_view name) {
      const auto words = split(std::string(names), ',');
      return std::ranges::find(words, name) != words.end();
    };
    if (run.args.given(p->name) && !is_output(*p) &&
        (in(excluded, p->name) || in(p->excludes, "samples") || in(p->excludes, "part")))
      fail({}, "{} needs all samples in one place: the tasks of a job have fixed ranges", run.args.spelled(p->name));
    if (!is_set && !by_task) params.push_back(p);
  }
  return params;
}

/// Renders or measures for a moment, so that errors appear now and not an hour later in each task. The part is written
/// and deleted in the folder of the tasks' parts.
void run_trial(const JobRun& run, const Divided& divided, const fs::path& parts,
               std::span<const JobParam* const> params) {
  const fs::path part = parts / "trial.part";
  Arguments args(params_of(divided.job), run.args.spelling());
  for (const JobParam* p : params)
    if (run.args.given(p->name) && !is_output(*p)) args.set(p->name, run.args.words(p->name));
  const int64_t amount = run.args.count(divided.amount);
  args.set("scene", run.args.text("scene"));
  args.set(divided.amount, std::to_string(amount));
  args.set("samples", fmt::format("0:{}", amount / run.args.count("tasks")));
  args.set("part", part.string());
  JobContext silent(silent_log(), run.context.options());
  run_job(divided.job, {silent, args, {.deadline = std::chrono::steady_clock::now()}});  // loads it, traces nothing
  fs::remove(part);
}

/// Returns the options of the divided job for the tasks. Options of the session that are not arguments (from Python)
/// are added.
std::vector<std::string> task_options(const JobRun& run, std::span<const JobParam* const> params) {
  std::vector<std::string> words = absolute_words(run.args, params);
  const auto& [threads, cache, plugins] = run.context.options();
  if (!run.args.given("plugin"))
    for (const std::string& plugin : plugins) words.insert(words.end(), {"--plugin", fs::absolute(plugin).string()});
  if (run.args.given("cache") || run.args.flag("no-cache") || cache == default_cache()) return words;
  if (cache.empty())
    words.emplace_back("--no-cache");
  else
    words.insert(words.end(), {"--cache", fs::absolute(cache).string()});
  return words;
}

/// Returns the engine of --engine or --slurm.
const Engine& chosen_engine(const Arguments& args) {
  const std::string name = args.flag("slurm") ? "slurm" : args.text("engine");
  if (name.empty()) fail({}, "submit: {} is needed: {}", args.spelled("engine"), fmt::join(kEngineNames, ", "));
  return *std::ranges::find(engines(), name, &Engine::name);
}

/// Returns the absolute path of the image, or of the table of a measurement. Throws InputError if it is not the name of
/// a file, or if the engine would misinterpret a part of it.
fs::path output_path(const Arguments& args, const Divided& divided, const Engine& engine) {
  const std::string name = divided.is_render() ? "output" : args.given("csv") ? "csv" : "json";
  if (!args.given(name))
    fail({}, "{} or {} is needed, which the merge writes", args.spelled("csv"), args.spelled("json"));
  const fs::path path = fs::absolute(args.text(name));
  if (!path.has_filename() || args.text(name) == "-")
    fail({}, "{} is not the name of a file: \"{}\"", args.spelled(name), args.text(name));
  if (path.string().find_first_of(engine.reserved) != std::string::npos)
    fail({}, "{}: {} cannot have any of {} in the path of a result: \"{}\"", args.spelled(name), engine.name,
         engine.reserved, path.string());
  divided.is_render() ? check_writable(path.string()) : check_replaceable(path.string());
  return path;
}

/// Returns the engine's command for a shell.
std::string command_text(const Engine& engine, const fs::path& folder) {
  std::string text;
  for (const std::string& word : command_of(engine, folder)) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

/// Throws InputError if the folder contains a job, of whichever engine: parts of two jobs have the same names.
void check_vacant(const fs::path& folder) {
  std::error_code error;
  for (const Engine& engine : engines())
    if (fs::exists(folder / engine.files.back().name, error))
      fail({}, "\"{}\" already contains a job: this adds what is missing: {}; delete the folder to start anew",
           folder.string(), command_text(engine, folder));
}

/// Returns the values of the @NAMES@ in the engine's files.
std::vector<std::pair<std::string, std::string>> values_of(const JobRun& run, const Divided& divided,
                                                           const Engine& engine, const fs::path& folder,
                                                           const fs::path& output,
                                                           std::vector<const JobParam*> params) {
  const int64_t tasks = run.args.count("tasks");
  const std::string scene = fs::absolute(run.args.text("scene")).string(),
                    amount = std::to_string(run.args.count(divided.amount)), name(divided.job.name),
                    option = fmt::format("--{}", divided.amount);
  const auto literals = [&engine](const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
      text += (text.empty() ? std::string_view() : engine.separator), text += engine.literal(word);
    return text;
  };
  const auto outputs = std::ranges::stable_partition(params, [](const JobParam* p) { return !is_output(*p); });
  const std::vector<std::string> of_merge = absolute_words(run.args, {outputs.begin(), outputs.end()});
  params.erase(outputs.begin(), outputs.end());
  const std::vector<std::string> options = task_options(run, params);
  std::vector<std::string> merge{"merge", "-o", output.string()};
  if (!divided.is_render()) {
    merge = {name, scene, option, amount};
    merge.insert(merge.end(), options.begin(), options.end());
    merge.insert(merge.end(), of_merge.begin(), of_merge.end());
  }
  return {{"@FROND@", engine.literal(program())},
          {"@COMMAND@", name},
          {"@SCENE@", engine.literal(scene)},
          {"@OUT@", engine.literal(output.string())},
          {"@FOLDER@", engine.literal(folder.string())},
          {"@OPTIONS@", literals(options)},
          {"@MERGE@", literals(merge)},
          {"@PART_OPTION@", divided.is_render() ? "" : "--merge="},
          {"@AMOUNT_OPTION@", option},
          {"@AMOUNT@", amount},
          {"@TASKS@", std::to_string(tasks)},
          {"@LAST_TASK@", std::to_string(tasks - 1)}};
}

/// Returns the last lines that an engine has printed to a file, for an error message, which is one line; empty if it
/// has printed nothing.
std::string last_lines(const fs::path& printed) {
  constexpr int kMostLines = 10;
  std::string text = read_file_bytes(printed, {});
  while (text.ends_with('\n')) text.pop_back();
  if (text.empty()) return "";
  size_t begin = text.size();
  for (int i = 0; i < kMostLines && begin != std::string::npos && begin > 0; ++i) begin = text.rfind('\n', begin - 1);
  if (begin != std::string::npos && begin > 0) text.erase(0, begin + 1);
  return fmt::format("; the end of \"{}\": {}", printed.string(), fmt::join(split(text, '\n'), " | "));
}

/// Starts the job. Returns the answer of a queue; empty if the engine has run the job itself and printed its progress
/// (if `is_quiet`, to a file in the folder). Throws InputError if the engine fails.
std::string start(const Engine& engine, const fs::path& folder, bool is_quiet) {
  const std::vector<std::string> command = command_of(engine, folder);
  if (engine.is_queue) {
    const auto child = run_child(command, "");
    if (!child || child->status != 0)
      fail({}, "\"{}\" could not submit the job: {}", command.front(), child ? child->err : "it cannot be run");
    return child->out;
  }
  const fs::path printed = is_quiet ? folder / fmt::format("{}.log", engine.name) : fs::path();
  const auto status = run_attached(command, printed);
  if (!status) fail({}, "{} cannot be run", engine.program);
  if (*status != 0)
    fail({}, "{} ended with {}; this renders what is missing: {}{}", engine.program, exit_text(*status),
         command_text(engine, folder), is_quiet ? last_lines(printed) : "");
  return "";
}

/// Writes the engine's files; the last one marks the folder as complete.
Result submit_divided(const JobRun& run, const Divided& divided) {
  const Arguments& args = run.args;
  const Engine& engine = chosen_engine(args);
  const int64_t tasks = args.count("tasks"), amount = args.count(divided.amount);
  if (args.text("scene") == "-") fail({}, "each task reads the scene: name a file instead of standard input");
  if (divided.is_render() && args.given("json")) fail({}, "{}: all tasks would write this file", args.spelled("json"));
  if (tasks > amount)
    fail({}, "{} tasks cannot share {} {}: each needs at least one", tasks, amount,
         divided.is_render() ? "samples" : "paths");
  const auto params = forwarded_params(run, divided);
  const fs::path output = output_path(args, divided, engine);
  if (args.flag("run") && !is_in_path(std::string(engine.program)))
    fail({}, "{} needs {}, which is not in PATH; to install it: {}", args.spelled("run"), engine.program,
         engine.package);
  const fs::path folder =
      fs::absolute(args.given("folder") ? args.text("folder") : fmt::format("{}.{}", output.string(), engine.name));
  check_vacant(folder);
  const auto values = values_of(run, divided, engine, folder, output, params);
  NewFiles files(folder);
  run_trial(run, divided, files.folder("parts"), params);
  for (const EngineFile& file : engine.files) {
    const std::string name(file.name);
    files.write(name, filled(file.content, values));
    if (file.is_executable)
      fs::permissions(files.file(name), fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
  }
  files.finish();
  const std::string command = command_text(engine, folder);
  const std::string text = args.flag("run")
                               ? start(engine, folder, args.flag("quiet"))
                               : fmt::format("{}\n  starts {} tasks and the merge{}\n", command, tasks, engine.advice);
  return {.facts = {{"command", command}}, .text = text};
}

Result submit(const JobRun& run) { return submit_divided(run, {kRenderJob, "spp", kSubmitParams}); }
Result submit_flux(const JobRun& run) { return submit_divided(run, {kFluxJob, "paths", kParamsOfMeasurements}); }
Result submit_brf(const JobRun& run) { return submit_divided(run, {kBrfJob, "paths", kParamsOfMeasurements}); }

}  // namespace

extern const JobInfo kSubmitFluxJob("submit-flux", "Cluster",
                                    "Write a job that measures the light budget of a scene by ranges of light paths, "
                                    "and merges them, as frond submit does.",
                                    "The options of frond flux are passed on to the tasks, the outputs to the merge.",
                                    kParamsOfMeasurements, SessionUse::all, submit_flux, &kFluxJob);
extern const JobInfo kSubmitBrfJob("submit-brf", "Cluster",
                                   "Write a job that measures a bidirectional reflectance factor by ranges of paths, "
                                   "and merges them, as frond submit does.",
                                   "The options of frond brf are passed on to the tasks, the outputs to the merge.",
                                   kParamsOfMeasurements, SessionUse::all, submit_brf, &kBrfJob);

extern const JobInfo kSubmitJob("submit", "Cluster",
                                "Write a job that renders ranges of samples and merges them, for Slurm, Open Job "
                                "Description or Snakemake; --run starts it.",
                                "The options of frond render are passed on to the tasks.", kSubmitParams,
                                SessionUse::all, submit, &kRenderJob);

}  // namespace frond
