#include "jobs/record/job.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <list>

#include "report/text_output.h"
#include "system/atomic_file.h"
#include "system/file_uses.h"
#include "system/new_files.h"

namespace frond {
namespace {

using enum ArgumentKind;

constexpr JobParam kSession[] = {
    JobParam("quiet", flag, "Print only errors, warnings and requested data.", {.aliases = "q"}),
    JobParam(
        "plugin", texts,
        "Shared object with further plug-ins. Shared objects in the folders of FROND_PLUGIN_PATH are always loaded.",
        {.type = "FILE", .path = PathUse::read, .decides = true}),
    JobParam("threads", count, "Number of threads; by default one for each processor. Results do not depend on it.",
             {.range = {1, 1024}, .aliases = "nthreads"}),
    JobParam("cache", text, "Folder for computed tables; by default $XDG_CACHE_HOME/frond, or ~/.cache/frond.",
             {.type = "FOLDER", .path = PathUse::write}),
    JobParam("no-cache", flag, "Store no computed tables on disk."),
};

/// File names identify a measurement without their folders, so that it can be moved.
std::string file_name(const JobParam& p, const std::string& word) {
  return p.path == PathUse::none ? word : std::filesystem::path(word).filename().string();
}

bool is_path(const JobParam& p, const std::string& word) { return p.path != PathUse::none && word != "-"; }

/// Notes the inputs among the arguments and plans the outputs. Throws InputError if an output cannot be written, is an
/// input, or is also another output; the job's function plans its further files.
std::list<PlannedOutput> planned_outputs(const Arguments& args) {
  const auto each_file = [&args](PathUse use, const auto& act) {
    for (const JobParam* p : args.params())
      if (p->path == use && args.given(p->name))
        for (const std::string& path : args.words(p->name)) act(*p, path);
  };
  each_file(PathUse::read, [](const JobParam&, const std::string& path) {
    if (path != "-") record_read(path, {});
  });
  std::list<PlannedOutput> outputs;
  each_file(PathUse::write, [&](const JobParam& p, const std::string& path) {
    if (path == "-" && p.type == "FOLDER")
      fail({}, "{}: a folder is needed, not standard output; if it is one, write ./-", args.spelled(p.name));
    outputs.emplace_back(args.spelled(p.name), path);
    if (path != "-" && p.type == "FILE") check_replaceable(path);
  });
  return outputs;
}

/// Writes the first table to the file of --csv, and the others that have one to files beside it: all or none.
void write_csv(const std::string& csv, const Result& result) {
  const Table& first = result.tables.at(0);
  if (result.csv_tables == 1 || csv == "-") return write_text(csv, to_csv(first, result.notes));
  const std::filesystem::path path(csv);
  NewFiles files(path.parent_path());
  files.write(path.filename().string(), to_csv(first, result.notes));
  for (size_t i = 1; i < result.csv_tables; ++i)
    files.write(std::filesystem::path(csv_beside(path, result.tables.at(i).name)).filename().string(),
                to_csv(result.tables[i], result.notes));
  files.finish();
}

/// Writes --csv and --json.
void write_outputs(const JobInfo& job, const JobRun& run, const Result& result) {
  for (const JobParam& p : job.params) {
    if (p.path != PathUse::write || !run.args.given(p.name)) continue;
    if (p.name == "csv") write_csv(run.args.text(p.name), result);
    if (p.name != "json") continue;
    const bool is_own = !result.json.empty();
    write_text(run.args.text(p.name), is_own ? result.json : to_json(result.notes, result.facts, result.tables));
  }
}

/// Adds the facts by which a measurement can be repeated: version, command, and seed; scenes add their hash. With
/// --provenance they are comments of CSV files, too.
void add_provenance(const JobInfo& job, const JobRun& run, Result& result) {
  if (job.group != "Measure") return;
  const auto has = [&result](std::string_view name) {
    return std::ranges::find(result.facts, name, &Fact::name) != result.facts.end();
  };
  result.facts.push_back({"version", std::string(FROND_VERSION)});
  result.facts.push_back({"command", identifying_command(job, run.args)});
  if (!has("seed") && run.args.declares("seed"))
    result.facts.push_back({"seed", std::to_string(run.args.seed("seed"))});
  if (!run.args.declares("provenance") || !run.args.flag("provenance")) return;
  for (const Fact& fact : result.facts)
    if (fact.name == "version" || fact.name == "command" || fact.name == "seed" || fact.name == "scene_hash")
      result.notes.push_back(fact.name + ": " + std::get<std::string>(fact.value));
}

/// Warns of options whose numbers are probably all in another unit.
void warn_of_units(const JobRun& run) {
  for (const JobParam* p : run.args.params()) {
    if (p->quantity == PhysicalQuantity::other || !run.args.given(p->name)) continue;
    const std::vector<double> values =
        p->kind == ArgumentKind::numbers ? run.args.numbers(p->name) : std::vector{run.args.real(p->name)};
    const auto hint = [p](double x) { return unit_hint(x, p->quantity, p->unit, p->range); };
    const auto first = std::ranges::find_if(values, [](double x) { return x != 0; });
    if (first == values.end() || std::ranges::any_of(values, [&](double x) { return x != 0 && hint(x).empty(); }))
      continue;
    run.log().warn({}, fmt::format("{}: {:g} {}: {}", run.args.spelled(p->name), *first, p->unit, hint(*first)));
  }
}

}  // namespace

/// --csv and --json are written after the log's check, so that strict mode does not write them on warnings.
Result run_job(const JobInfo& job, const JobRun& run) {
  run.args.check();
  const FileUses uses;
  const std::list<PlannedOutput> outputs = planned_outputs(run.args);
  StrictLog& log = run.context.log();
  log.begin(run.args.declares("strict") && run.args.flag("strict"));
  warn_of_units(run);
  Result result = [&] {
    const StopScope stop(run.control.stop);
    return job.run(run);
  }();
  log.check();
  add_provenance(job, run, result);
  if (!result.stopped) write_outputs(job, run, result);
  return result;
}

/// A time limit beyond what a clock can count is none.
RenderControl JobRun::control_until(double seconds, std::chrono::steady_clock::time_point start) const {
  using Clock = std::chrono::steady_clock;
  RenderControl until = control;
  constexpr double kEndless = 1e9;  // beyond it a clock's ticks could overflow
  if (seconds > 0 && seconds < kEndless)
    until.deadline = start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  return until;
}

void JobRun::check_stop() const {
  if (control.stop.stop_requested()) throw Stopped();
}

/// kSession is sorted so that each SessionUse is a prefix of it.
std::span<const JobParam> session_params(SessionUse use) {
  constexpr size_t kUsed[] = {1, 2, 3, std::size(kSession)};
  return std::span(kSession).first(kUsed[size_t(use)]);
}

std::filesystem::path default_cache() {
  if (const char* base = std::getenv("XDG_CACHE_HOME"); base && *base) return std::filesystem::path(base) / "frond";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "frond";
  return {};
}

/// Missing declarations keep the defaults: no plug-ins, one thread for each processor, no cache.
SessionOptions session_options(const Arguments& args) {
  SessionOptions options;
  if (args.declares("plugin")) options.plugins = args.texts("plugin");
  if (!args.declares("threads")) return options;
  options.threads = int(args.count("threads"));
  if (!args.declares("cache")) return options;
  if (!args.flag("no-cache"))
    options.cache = args.given("cache") ? std::filesystem::path(args.text("cache")) : default_cache();
  return options;
}

/// A parameter of the job hides a parameter of the same name in the extended job.
std::vector<const JobParam*> params_of(const JobInfo& job) {
  std::vector<const JobParam*> all;
  const auto add = [&all](std::span<const JobParam> params) {
    for (const JobParam& p : params)
      if (std::ranges::find(all, p.name, &JobParam::name) == all.end()) all.push_back(&p);
  };
  add(job.params);
  if (job.extends) add(job.extends->params);
  add(session_params(job.session));
  return all;
}

/// Linear search: there are some twenty jobs.
const JobInfo& find_job(std::string_view name) {
  std::vector<std::string_view> names;
  for (const JobInfo* job : all_jobs()) {
    if (job->name == name) return *job;
    names.push_back(job->name);
  }
  fail({}, "there is no command \"{}\"{}", name, suggestion(name, names));
}

/// Positional words come first; options follow in the order of the records, so that equal runs give equal text.
std::string identifying_command(const JobInfo& job, const Arguments& args) {
  std::string positional, options;
  for (const JobParam* p : args.params()) {
    if (!p->decides || !args.given(p->name)) continue;
    if (p->kind == flag) {
      if (args.flag(p->name)) options += " --" + std::string(p->name);
      continue;
    }
    for (const std::string& word : args.words(p->name))
      p->positional ? positional += ' ' + file_name(*p, word)
                    : options += fmt::format(" --{} {}", p->name, file_name(*p, word));
  }
  return fmt::format("frond {}{}{}", job.name, positional, options);
}

std::vector<std::string> absolute_words(const Arguments& args, std::span<const JobParam* const> params) {
  std::vector<std::string> result;
  for (const JobParam* p : params) {
    if (!args.given(p->name)) continue;
    const std::string name = "--" + std::string(p->name);
    if (p->kind == flag) {
      if (args.flag(p->name)) result.push_back(name);
      continue;
    }
    for (const std::string& word : args.words(p->name)) {
      if (!p->positional) result.push_back(name);
      result.push_back(is_path(*p, word) ? std::filesystem::absolute(word).string() : word);
    }
  }
  return result;
}

std::string csv_beside(const std::filesystem::path& csv, std::string_view table) {
  return (csv.parent_path() / fmt::format("{}-{}{}", csv.stem().string(), table, csv.extension().string())).string();
}

std::string material_text(const std::vector<std::string>& words) {
  if (words.empty()) return {};
  const std::string& text = words.front();
  if (text.empty()) fail({}, "a material is needed, as in leaf,specimen=maize");
  // After the name a blank is part of a value, such as a file's path.
  const size_t end = text.find_first_of("=, ");
  if (words.size() > 1 || (end != std::string::npos && text[end] == ' '))
    fail({}, "a material is one word with commas, as in leaf,specimen=maize: \"{}\" was given", fmt::join(words, " "));
  return text;
}

}  // namespace frond
