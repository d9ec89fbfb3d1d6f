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
#include "system/child_process.h"
#include "system/file_bytes.h"
#include "system/new_files.h"

namespace frond {

// `frond submit`: a job of tasks, each with a range of samples, and a merge of their parts, for one of several engines
// (docs/many_machines.md).

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

/// Parameters of the job itself; JobInfo::extends adds the parameters of `frond render`.
const JobParam kParams[] = {
    JobParam("scene", text, "Scene file.",
             {.type = "SCENE", .path = PathUse::read, .positional = true, .required = true}),
    JobParam("output", text, "Image that the merge writes.",
             {.type = "FILE", .aliases = "o,outfile", .path = PathUse::write, .required = true}),
    JobParam("spp", count, "Number of samples per pixel.", {.range = {1, 1 << 30}, .required = true}),
    JobParam("tasks", count, "Number of tasks, among which the samples are divided.",
             {.range = {1, 1e6}, .required = true}),
    JobParam("engine", text, "Program that schedules the tasks: Slurm, Open Job Description, or Snakemake.",
             {.choices = kEngineNames}),
    JobParam("slurm", flag, "The same as --engine slurm.", {.excludes = "engine"}),
    JobParam("run", flag,
             "Also start the job: submit it with sbatch, or run it here with openjd or snakemake, whose output --quiet "
             "writes to FOLDER/ENGINE.log."),
    JobParam("folder", text, "Folder of the job's files, parts and logs; OUTPUT.ENGINE by default.",
             {.type = "FOLDER", .path = PathUse::write}),
};

/// Parameters of `frond render` that each task sets itself.
constexpr std::string_view kSetByTasks[] = {"part",       "samples", "checkpoint", "resume",
                                            "time-limit", "threads", "pilot"};

/// Returns the frond program that tasks run: this executable, or from Python the one on the tasks' PATH.
std::string program() {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  return self.filename().string().starts_with("python") ? "frond" : self.string();
}

/// Returns the parameters that are passed on to `frond render`: its own, except those that submit or the tasks set.
std::vector<const JobParam*> forwarded_params(const JobRun& run) {
  std::vector<const JobParam*> params;
  for (const JobParam* p : params_of(kRenderJob)) {
    const bool is_set = std::ranges::find(kParams, p->name, &JobParam::name) != std::end(kParams);
    const bool by_task = std::ranges::count(kSetByTasks, p->name) > 0;
    if (by_task && run.args.given(p->name)) fail({}, "{} is set by each task", run.args.spelled(p->name));
    if (!is_set && !by_task) params.push_back(p);
  }
  return params;
}

/// Renders for a moment, so that errors appear now and not an hour later in each task. The part is written and deleted
/// in the folder of the tasks' parts.
void render_trial(const JobRun& run, const fs::path& parts, std::span<const JobParam* const> params) {
  const fs::path part = parts / "trial.part";
  Arguments args(params_of(kRenderJob), run.args.spelling());
  for (const JobParam* p : params)
    if (run.args.given(p->name)) args.set(p->name, run.args.words(p->name));
  args.set("scene", run.args.text("scene"));
  args.set("samples", fmt::format("0:{}", run.args.count("spp") / run.args.count("tasks")));
  args.set("part", part.string());
  JobContext silent(silent_log(), run.context.options());
  run_job(kRenderJob, {silent, args, {.deadline = std::chrono::steady_clock::now()}});  // loads it, renders nothing
  fs::remove(part);
}

/// Returns the options of `frond render` for the tasks. Options of the session that are not arguments (from Python) are
/// added.
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

/// Returns the absolute path of the image. Throws InputError if it is not the name of a file, or if the engine would
/// misinterpret a part of it.
fs::path image_path(const Arguments& args, const Engine& engine) {
  const fs::path path = fs::absolute(args.text("output"));
  if (!path.has_filename())
    fail({}, "{} is not the name of an image: \"{}\"", args.spelled("output"), args.text("output"));
  if (path.string().find_first_of(engine.reserved) != std::string::npos)
    fail({}, "{}: {} cannot have any of {} in the path of an image: \"{}\"", args.spelled("output"), engine.name,
         engine.reserved, path.string());
  check_writable(path.string());
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
      fail({}, "\"{}\" already contains a job: this renders the missing samples: {}; delete the folder to start anew",
           folder.string(), command_text(engine, folder));
}

/// Returns the values of the @NAMES@ in the engine's files.
std::vector<std::pair<std::string, std::string>> values_of(const JobRun& run, const Engine& engine,
                                                           const fs::path& folder, const fs::path& output,
                                                           std::span<const JobParam* const> params) {
  const int64_t tasks = run.args.count("tasks");
  std::string options;
  for (const std::string& word : task_options(run, params))
    options += (options.empty() ? std::string_view() : engine.separator), options += engine.literal(word);
  return {{"@FROND@", engine.literal(program())},
          {"@SCENE@", engine.literal(fs::absolute(run.args.text("scene")).string())},
          {"@OUT@", engine.literal(output.string())},
          {"@FOLDER@", engine.literal(folder.string())},
          {"@OPTIONS@", options},
          {"@SPP@", std::to_string(run.args.count("spp"))},
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

/// The job: writes the engine's files; the last one marks the folder as complete.
Result submit(const JobRun& run) {
  const Arguments& args = run.args;
  const Engine& engine = chosen_engine(args);
  const int64_t tasks = args.count("tasks"), samples = args.count("spp");
  if (args.text("scene") == "-") fail({}, "each task reads the scene: name a file instead of standard input");
  if (args.given("max-rms"))
    fail({}, "{} needs all samples in one place: the tasks of a job have fixed ranges", args.spelled("max-rms"));
  if (args.given("json")) fail({}, "{}: all tasks would write this file", args.spelled("json"));
  if (tasks > samples) fail({}, "{} tasks cannot share {} samples: each needs at least one", tasks, samples);
  const fs::path output = image_path(args, engine);
  if (args.flag("run") && !is_in_path(std::string(engine.program)))
    fail({}, "{} needs {}, which is not in PATH; to install it: {}", args.spelled("run"), engine.program,
         engine.package);
  const fs::path folder =
      fs::absolute(args.given("folder") ? args.text("folder") : fmt::format("{}.{}", args.text("output"), engine.name));
  check_vacant(folder);
  const auto params = forwarded_params(run);
  const auto values = values_of(run, engine, folder, output, params);
  NewFiles files(folder);
  render_trial(run, files.folder("parts"), params);
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

}  // namespace

extern const JobInfo kSubmitJob("submit", "Cluster",
                                "Write a job that renders ranges of samples and merges them, for Slurm, Open Job "
                                "Description or Snakemake; --run starts it.",
                                "The options of frond render are passed on to the tasks.", kParams, SessionUse::all,
                                submit, &kRenderJob);

}  // namespace frond
