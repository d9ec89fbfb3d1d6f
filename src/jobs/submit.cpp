#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "jobs/support/render_task.h"
#include "jobs/support/templates.h"
#include "report/text_output.h"
#include "system/atomic_file.h"
#include "system/child_process.h"

namespace frond {

// `frond submit`: a cluster job of one array of tasks, each with a range of samples, and a job that merges their parts
// (docs/many_machines.md).

namespace {

namespace fs = std::filesystem;
using enum ArgumentKind;

/// Parameters of the job itself; those of `frond render` are added by JobInfo::extends.
constexpr JobParam kParams[] = {
    JobParam("scene", text, "Scene file.",
             {.type = "SCENE", .path = PathUse::read, .positional = true, .required = true}),
    JobParam("output", text, "Image that the merge job writes.",
             {.type = "FILE", .aliases = "o,outfile", .path = PathUse::write, .required = true}),
    JobParam("spp", count, "Number of samples per pixel.", {.range = {1, 1 << 30}, .required = true}),
    JobParam("tasks", count, "Number of tasks, among which the samples are divided.",
             {.range = {1, 1e6}, .required = true}),
    JobParam("slurm", flag, "Write a job for Slurm.", {.required = true}),
    JobParam("run", flag, "Also submit the job with sbatch."),
    JobParam("folder", text, "Folder of the job's scripts, parts and logs; OUTPUT.slurm by default.",
             {.type = "FOLDER", .path = PathUse::write}),
};

/// Parameters of `frond render` that each task sets itself.
constexpr std::string_view kSetByTasks[] = {"part",       "samples", "checkpoint", "resume",
                                            "time-limit", "threads", "pilot"};

/// Quotes a word for a POSIX shell.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

/// Replaces each name in the template by its value.
std::string filled(std::string_view text_template, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text(text_template);
  for (const auto& [name, value] : values)
    for (size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size())
      text.replace(at, name.size(), value);
  return text;
}

/// Returns the frond program that tasks run: this executable, or from Python the one on the tasks' PATH.
std::string program() {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  return self.filename().string().starts_with("python") ? "frond" : self.string();
}

/// Returns the parameters that are passed on to `frond render`: its own, except those that submit or the tasks set.
std::vector<const JobParam*> handed_on(const JobRun& run) {
  std::vector<const JobParam*> params;
  for (const JobParam* p : params_of(kRenderJob)) {
    const bool is_set = std::ranges::find(kParams, p->name, &JobParam::name) != std::end(kParams);
    const bool by_task = std::ranges::count(kSetByTasks, p->name) > 0;
    if (by_task && run.args.given(p->name)) fail({}, "{} is set by each task", run.args.spelled(p->name));
    if (!is_set && !by_task) params.push_back(p);
  }
  return params;
}

/// Renders for a moment, so that errors appear now and not an hour later in each task.
void try_out(const JobRun& run, const fs::path& folder, std::span<const JobParam* const> params) {
  const fs::path part = folder / "parts" / "trial.part";
  Arguments args(params_of(kRenderJob), run.args.spelling());
  for (const JobParam* p : params)
    if (run.args.given(p->name)) args.set(p->name, run.args.words(p->name));
  args.set("scene", run.args.text("scene"));
  args.set("samples", fmt::format("0:{}", run.args.count("spp") / run.args.count("tasks")));
  args.set("time-limit", "0.001");
  args.set("part", part.string());
  try {
    JobContext silent(silent_log(), run.context.options());
    run_job(kRenderJob, {silent, args, {}});
    fs::remove(part);
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& left : {part, part.parent_path(), folder}) fs::remove(left, ignored);
    throw;
  }
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

/// The job: writes the scripts of an array job and its merge job; render.sbatch is written last and marks the folder as
/// complete.
Result submit(const JobRun& run) {
  const Arguments& args = run.args;
  const int64_t tasks = args.count("tasks"), samples = args.count("spp");
  if (tasks > samples) fail({}, "{} tasks cannot share {} samples: each needs at least one", tasks, samples);
  const std::string output = args.text("output");
  if (!fs::path(output).has_filename())
    fail({}, "{} is not the name of an image: \"{}\"", args.spelled("output"), output);
  const fs::path folder = fs::absolute(args.given("folder") ? args.text("folder") : output + ".slurm");
  std::error_code error;
  if (fs::exists(folder / "render.sbatch", error))
    fail({}, "\"{}\" already contains a job: its submit.sh renders the missing samples; delete it to start anew",
         folder.string());
  const auto params = handed_on(run);
  make_folders(folder / "parts");
  try_out(run, folder, params);
  std::string options;
  for (const std::string& word : task_options(run, params)) options += (options.empty() ? "" : " ") + quoted(word);
  const std::vector<std::pair<std::string, std::string>> values{
      {"@FROND@", quoted(program())},
      {"@SCENE@", quoted(fs::absolute(args.text("scene")).string())},
      {"@OUT@", quoted(fs::absolute(output).string())},
      {"@OPTIONS@", options},
      {"@SPP@", std::to_string(samples)},
      {"@TASKS@", std::to_string(tasks)},
      {"@LAST_TASK@", std::to_string(tasks - 1)}};
  // render.sbatch is written last: its existence marks a complete job.
  const fs::path script = folder / "submit.sh";
  write_text((folder / "merge.sbatch").string(), filled(merge_sbatch, values));
  write_text(script.string(), filled(submit_sh, values));
  fs::permissions(script, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
  write_text((folder / "render.sbatch").string(), filled(render_sbatch, values));
  Result result{.facts = {{"script", script.string()}}};
  if (!args.flag("run")) {
    result.text = fmt::format(
        "{} submits {} tasks and the merge job; first adapt render.sbatch in the same folder to your cluster\n",
        script.string(), tasks);
    return result;
  }
  const auto child = run_child({script.string()}, "");
  if (!child || child->status != 0)
    fail({}, "\"{}\" could not submit the job: {}", script.string(), child ? child->err : "it cannot be run");
  result.text = child->out;
  return result;
}

}  // namespace

extern const JobInfo kSubmitJob("submit", "Cluster",
                                "Write the scripts of a Slurm array job that renders ranges of samples, and of the job "
                                "that merges them; --run submits them.",
                                "The options of frond render are passed on to the tasks.", kParams, SessionUse::all,
                                submit, &kRenderJob);

}  // namespace frond
