#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jobs/record/arguments.h"
#include "jobs/record/strict_log.h"
#include "render/session.h"
#include "report/table.h"

/// A job is what one command does: `frond brf`, frond.brf(). It is defined once, by a record of its parameters and a
/// function. The command line, man pages, shell completion, docs/commands.md and the Python module are made from the
/// records.
namespace frond {

/// What a job leaves behind, beside the files that it has written.
struct Result {
  std::vector<Table> tables = {};        ///< the first one is what --csv writes
  std::vector<Fact> facts = {};          ///< single values
  std::vector<std::string> notes = {};   ///< comments of CSV: who measured what
  std::string text = {};                 ///< for a terminal
  std::string json = {};                 ///< what --json writes, where that is not made of notes, facts and tables
  std::vector<std::string> errors = {};  ///< what is wrong with the input, for standard error; the code is 1
  bool is_requested = false;             ///< the text is what was asked for, by --json for one: --quiet keeps it
  int code = 0;                          ///< of the program: 0 done, 1 something is wrong, 2 a law is broken
  bool stopped = false;                  ///< by the control's stop token; what was done is kept
};

/// What a job works with. The session is made when it is first asked for: some jobs do without.
class JobContext {
 public:
  /// `to` must outlive it.
  JobContext(const Log& to, SessionOptions options) : options_(std::move(options)), log_(to) {}

  Session& session() {
    if (!session_) session_.emplace(log_, options_);
    return *session_;
  }
  const SessionOptions& options() const { return options_; }
  /// The session's log. `log().begin(true)` makes warnings errors.
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
  RenderControl control = {};  ///< progress and stop token of the front end

  Session& session() const { return context.session(); }
  const Log& log() const { return context.log(); }
  /// The control, with a deadline `seconds` after now if they are above 0.
  RenderControl control_until(double seconds) const;
  /// Throws Stopped if the front end asks for an end: for jobs that call it between measurements.
  void check_stop() const;
};

/// Ends a job whose partial result is of no use.
struct Stopped : std::runtime_error {
  Stopped() : std::runtime_error("stopped") {}
};

/// Which parameters of the session a job has beside its own.
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
  std::string_view group;    ///< heading of `frond --help`: "Render", "Leaf models", "Measure", ...
  std::string_view doc;      ///< one sentence
  std::string_view details;  ///< further sentences, for --help, man pages and docstrings; may be empty
  std::span<const JobParam> params;
  SessionUse session;
  Result (*run)(const JobRun&);
  const JobInfo* extends;  ///< another job whose parameters this one takes too, and passes on; nullptr: none
};

/// All parameters of a job: its own, those of the job that it extends, and those of its session.
std::vector<const JobParam*> params_of(const JobInfo& job);

/// Those of quiet, plugin, threads, cache and no-cache that SessionUse names.
std::span<const JobParam> session_params(SessionUse use);
/// The session that such arguments ask for. The cache's folder is that given, else the user's, or none with no-cache.
SessionOptions session_options(const Arguments& args);
/// The user's folder for computed tables: $XDG_CACHE_HOME/frond, else ~/.cache/frond; empty where neither is set.
std::filesystem::path default_cache();

/// All jobs, group by group. The only list of them.
std::span<const JobInfo* const> all_jobs();
/// Throws InputError that names the nearest one.
const JobInfo& find_job(std::string_view name);

/// Checks the arguments and the outputs, runs the job, writes --csv and --json.
Result run_job(const JobInfo& job, const JobRun& run);

/// The arguments that decide the result, as a command line: what identifies a measurement or a part. Files stand by
/// their names without folders.
std::string identifying_command(const JobInfo& job, const Arguments& args);
/// Arguments for these parameters as words of a command line, with absolute paths: for a job that runs in another
/// folder.
std::vector<std::string> absolute_words(const Arguments& args, std::span<const JobParam* const> params);

// Helpers that jobs share.

/// A material in text: NAME[,parameter=value...]. The old form, in several words or in one with blanks, `abm
/// specimen=maize`, is accepted with a note.
std::string material_text(const std::vector<std::string>& words, const Log& log);

}  // namespace frond
