#include <fmt/format.h>

#include "core/messages/counted.h"
#include "image/image_file.h"
#include "jobs/record/common_params.h"

namespace frond {

// `frond check`: reads and checks scenes without building or rendering them.

namespace {

constexpr JobParam kCheckParams[] = {
    JobParam("scene", ArgumentKind::texts, "Scene files (pbrt-v4 format).",
             {.type = "SCENE", .path = PathUse::read, .scene = true, .positional = true, .required = true}),
    kIgnoreUnsupportedParam,
    kStrictParam,
};

/// Result of reading one scene.
struct CheckFindings {
  Problems problems;  ///< of its files, plug-ins, parameters and image name; in strict mode also its warnings
  size_t warnings = 0;
};

CheckFindings findings_of(const JobRun& run, const SceneInput& input) {
  StrictLog& log = run.context.log();
  log.begin(run.args.flag("strict"));
  Session& session = run.session();
  CheckFindings findings;
  Problems& problems = findings.problems;
  const SceneDescription description = read_scene(run, input, problems);
  if (!description.files.empty()) problems.attempt([&] { session.check(description); });
  problems.attempt([&] { check_image_name(session.film(description).filename, description.film.where); });
  problems.attempt([&] { log.check(); });
  findings.warnings = log.warnings();
  log.begin(false);
  return findings;
}

/// Returns "1 error", "2 errors" or "no errors".
std::string counted_or_no(size_t count, const char* what) {
  if (count == 0) return fmt::format("no {}s", what);
  return counted(count, what);
}

/// The job: checks every scene, and reports all errors. The exit code is 1 if there is an error.
Result check(const JobRun& run) {
  Result result{.tables = {{"problems"}}};
  for (const SceneInput& input : scenes_of(run)) {
    const auto [problems, warnings] = findings_of(run, input);
    const std::string name = input.files.back().string();
    for (const std::string& message : problems.messages()) {
      result.tables[0].add("scene", name);
      result.tables[0].add("problem", message);
      result.errors.push_back(message);
    }
    const size_t count = problems.count();
    result.text += fmt::format("{}: {}{}\n", name, counted_or_no(count, "error"),
                               warnings == 0 ? "" : ", " + counted(warnings, "warning"));
    if (count > 0) result.code = 1;
  }
  return result;
}

}  // namespace

extern const JobInfo kCheckJob("check", "Scenes", "Read scenes and all files that they name, and report all errors.",
                               "Nothing is rendered. The exit status is 1 if there is an error.", kCheckParams,
                               SessionUse::plugins, check);

}  // namespace frond
