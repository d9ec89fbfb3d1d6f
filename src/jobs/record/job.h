#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jobs/record/arguments.h"
#include "jobs/record/scene_in_memory.h"
#include "jobs/record/strict_log.h"
#include "render/session.h"
#include "report/table.h"

/// A job is the work of one command, for `frond brf` and frond.brf() alike. It is defined by one record of its
/// parameters and one function. The command line, man pages, shell completion, docs/commands.md and the Python module
/// are made from the records.
namespace frond {

/// Result of a job, apart from the files that it has written.
struct Result {
  std::vector<Table> tables = {};        ///< --csv writes the first one
  size_t csv_tables = 1;                 ///< --csv writes so many, the others to files beside its own (csv_beside)
  std::vector<Fact> facts = {};          ///< single values
  std::vector<std::string> notes = {};   ///< comment lines of the CSV file: materials, conventions, provenance
  std::string text = {};                 ///< for a terminal
  std::string json = {};                 ///< content of --json; if empty, it is made of notes, facts and tables
  std::vector<std::string> errors = {};  ///< errors in the input, for standard error; the exit code is then 1
  bool is_requested = false;             ///< `text` is requested data, as by --json: --quiet prints it too
  int code = 0;                          ///< exit code of the program: 0 done, 1 error, 2 a law is broken
  bool stopped = false;                  ///< by the control's stop token; the partial result is kept
};

/// Services of a job. The session is created on first use, because some jobs do not need one.
class JobContext {
 public:
  /// `to` must outlive this object.
  JobContext(const Log& to, SessionOptions options) : options_(std::move(options)), log_(to) {}

  /// Returns the session; creates it on first use. Throws InputError, for instance for a plug-in that cannot be loaded.
  Session& session() {
    if (!session_) session_.emplace(log_, options_);
    return *session_;
  }
  const SessionOptions& options() const { return options_; }
  /// Returns the session's log. `log().begin(true)` turns warnings into errors.
  StrictLog& log() { return log_; }

 private:
  SessionOptions options_;
  StrictLog log_;
  std::optional<Session> session_;
};

/// One run of a job.
struct JobRun {
  JobContext& context;
  const Arguments& args;
  RenderControl control = {};                ///< progress and stop token of the front end
  std::map<size_t, GivenScene> scenes = {};  ///< in place of files: by the index of a word of the scene parameter

  Session& session() const { return context.session(); }
  const Log& log() const { return context.log(); }
  /// Returns the control, with a deadline `seconds` after `start` if `seconds` is above 0.
  RenderControl control_until(double seconds,
                              std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now()) const;
  /// Throws Stopped if the front end has requested a stop. Jobs call it between measurements.
  void check_stop() const;
};

/// Session parameters that a job has in addition to its own.
enum class SessionUse : uint8_t {
  none,     ///< quiet
  plugins,  ///< quiet, plugin
  threads,  ///< quiet, plugin, threads
  all,      ///< quiet, plugin, threads, cache, no-cache
};

/// One job: its record and its function.
struct JobInfo {
  constexpr JobInfo(std::string_view its_name, std::string_view its_group, std::string_view its_doc,
                    std::string_view its_details, std::span<const JobParam> its_params, SessionUse its_session,
                    Result (*its_run)(const JobRun&), const JobInfo* extended = nullptr)
      : name(its_name),
        group(its_group),
        doc(its_doc),
        details(its_details),
        params(its_params),
        session(its_session),
        run(its_run),
        extends(extended) {}

  std::string_view name;
  std::string_view group;    ///< heading in `frond --help`: "Render", "Leaf models", "Measure", ...
  std::string_view doc;      ///< one sentence
  std::string_view details;  ///< further sentences for --help, man pages and docstrings; may be empty
  std::span<const JobParam> params;
  SessionUse session;
  Result (*run)(const JobRun&);
  const JobInfo* extends;  ///< job whose parameters this job also accepts, and passes on; nullptr: none
};

/// Returns all parameters of a job: its own, those of the extended job, and those of its session.
std::vector<const JobParam*> params_of(const JobInfo& job);

/// Returns the parameters among quiet, plugin, threads, cache and no-cache that `use` names.
std::span<const JobParam> session_params(SessionUse use);
/// Returns the session's options from the arguments. The cache folder is --cache, else default_cache(), or none with
/// --no-cache.
SessionOptions session_options(const Arguments& args);
/// Returns the user's folder for computed tables: $XDG_CACHE_HOME/frond, else ~/.cache/frond; empty if neither variable
/// is set.
std::filesystem::path default_cache();

/// Returns all jobs, sorted by group. This is the only list of them.
std::span<const JobInfo* const> all_jobs();
/// Throws InputError for an unknown name; the message suggests the nearest one.
const JobInfo& find_job(std::string_view name);

/// Checks the arguments and outputs, runs the job, and writes --csv and --json. Throws InputError.
Result run_job(const JobInfo& job, const JobRun& run);

/// Returns the arguments that decide the result as a command line: the identity of a measurement or a part. Files are
/// written without their folders.
std::string identifying_command(const JobInfo& job, const Arguments& args);
/// Returns the arguments for `params` as words of a command line with absolute paths, for a job that runs in another
/// folder.
std::vector<std::string> absolute_words(const Arguments& args, std::span<const JobParam* const> params);

// Helpers that jobs share.

/// Returns the file of a further table, beside the file of --csv: leaves-flux.csv for the table "flux" beside
/// leaves.csv.
std::string csv_beside(const std::filesystem::path& csv, std::string_view table);

/// Returns the material NAME[,parameter=value...], the only word; empty without words. Throws InputError if there are
/// several, or if blanks separate the parameters.
std::string material_text(const std::vector<std::string>& words);

}  // namespace frond
