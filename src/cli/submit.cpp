#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/slurm_templates.h"
#include "core/error.h"
#include "report/text_output.h"
#include "system/child_process.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

struct SubmitOptions {
  std::string scene, output, folder;
  std::vector<std::string> render_options;
  int samples = 0, tasks = 0;
  bool slurm = false, run = false;
};

/// As a shell reads it.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string filled(std::string_view text_template, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text(text_template);
  for (const auto& [name, value] : values)
    for (size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size())
      text.replace(at, name.size(), value);
  return text;
}

/// Hardly anything is rendered now: what would be refused an hour later, in each task, is refused here.
void try_out(const SubmitOptions& o) {
  const fs::path part = fs::path(o.folder) / "parts" / "trial.part";
  std::vector<std::string> words{"frond", "render", o.scene};
  words.insert(words.end(), o.render_options.begin(), o.render_options.end());
  for (const std::string& word :
       {std::string("--samples"), fmt::format("0:{}", o.samples / o.tasks), std::string("--time-limit"),
        std::string("0.001"), std::string("--quiet"), std::string("--part")})
    words.push_back(word);
  words.push_back(part.string());
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  const int code = run(int(arguments.size()), arguments.data());
  fs::remove(part);
  if (code == 0) return;
  for (const fs::path& empty : {part.parent_path(), fs::path(o.folder)}) {
    std::error_code is_not_empty;
    fs::remove(empty, is_not_empty);
  }
  throw CLI::RuntimeError(code);  // it has said why
}

/// Tasks run in another folder.
void make_absolute(std::vector<std::string>& options) {
  for (size_t i = 1; i < options.size(); ++i)
    if (options[i - 1] == "--plugin" || options[i - 1] == "--cache") options[i] = fs::absolute(options[i]).string();
}

void check(const SubmitOptions& o) {
  if (!o.slurm) fail({}, "submit: --slurm is needed: it is what frond knows to submit to");
  if (o.tasks > o.samples) fail({}, "submit: {} tasks cannot share {} samples: one each at least", o.tasks, o.samples);
  if (!fs::path(o.output).has_filename()) fail({}, "submit: -o names no image: \"{}\"", o.output);
  std::error_code error;
  if (fs::exists(fs::path(o.folder) / "render.sbatch", error))
    fail({}, "\"{}\" holds a job already: its submit.sh goes on with what is missing; delete it to begin anew",
         o.folder);
}

void submit(SubmitOptions o) {
  if (o.folder.empty()) o.folder = o.output + ".slurm";
  check(o);
  o.folder = fs::absolute(o.folder).string();
  make_absolute(o.render_options);
  fs::create_directories(fs::path(o.folder) / "parts");
  try_out(o);
  std::string options;
  for (const std::string& option : o.render_options) options += (options.empty() ? "" : " ") + quoted(option);
  const std::vector<std::pair<std::string, std::string>> values{
      {"@FROND@", quoted(fs::read_symlink("/proc/self/exe").string())},
      {"@SCENE@", quoted(fs::absolute(o.scene).string())},
      {"@OUT@", quoted(fs::absolute(o.output).string())},
      {"@OPTIONS@", options},
      {"@SPP@", std::to_string(o.samples)},
      {"@TASKS@", std::to_string(o.tasks)},
      {"@LAST_TASK@", std::to_string(o.tasks - 1)}};
  const fs::path folder = o.folder, script = folder / "submit.sh";
  write_text((folder / "merge.sbatch").string(), filled(merge_sbatch, values));
  write_text(script.string(), filled(submit_sh, values));
  fs::permissions(script, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
  write_text((folder / "render.sbatch").string(), filled(render_sbatch, values));
  if (!o.run) {
    fmt::print("{} submits {} tasks and the merge after them; edit render.sbatch beside it first, for your cluster\n",
               script.string(), o.tasks);
    return;
  }
  const auto result = run_child({script.string()}, "");
  if (!result || result->status != 0)
    fail({}, "\"{}\" could not submit the job: {}", script.string(), result ? result->err : "it cannot be run");
  fmt::print("{}", result->out);
}

}  // namespace

void add_submit_command(CLI::App& app) {
  auto* command = app.add_subcommand("submit", "Render on a cluster: an array job of sample ranges, and their merge.");
  auto o = std::make_shared<SubmitOptions>();
  command->add_option("scene", o->scene, "Scene file.")->type_name("SCENE")->required();
  command->add_option("-o,--output", o->output, "Image that the merge writes.")->type_name("FILE")->required();
  add_count_option(*command, "--spp", o->samples, 1 << 30, "Samples per pixel.")->required();
  add_count_option(*command, "--tasks", o->tasks, 1'000'000, "Tasks that share them.")->required();
  command->add_flag("--slurm", o->slurm, "Write a job for Slurm.");
  command->add_flag("--run", o->run, "Submit it too, by sbatch.");
  command->add_option("--folder", o->folder, "Where the job's scripts, parts and logs go; OUTPUT.slurm by default.")
      ->type_name("FOLDER");
  command->allow_extras();
  command->footer("Further options are handed to frond render, such as --wavelengths smpte.");
  command->callback([o, command] {
    o->render_options = command->remaining();
    submit(*o);
  });
}

}  // namespace frond
