#include <fmt/format.h>

#include "image/image_file.h"
#include "jobs/record/common_params.h"

namespace frond {

// `frond check`: reads and checks scenes without building or rendering them.

namespace {

constexpr JobParam kParams[] = {
    JobParam("scene", ArgumentKind::texts, "Scene files (pbrt-v4 format).",
             {.type = "SCENE", .path = PathUse::read, .positional = true, .required = true}),
    kIgnoreUnsupportedParam,
    kStrictParam,
};

/// Returns all errors of one scene: of its files, its plug-ins and parameters, its image's name, and in strict mode its
/// warnings.
Problems problems_of(const JobRun& run, const std::vector<std::filesystem::path>& files) {
  StrictLog& log = run.context.log();
  log.begin(run.args.flag("strict"));
  Session& session = run.session();
  Problems problems;
  const SceneDescription description = session.read(files, unsupported_of(run.args), problems);
  if (!description.files.empty()) problems.attempt([&] { session.check(description); });
  problems.attempt([&] { check_image_name(session.film(description).filename, description.film.where); });
  problems.attempt([&] { log.check(); });
  log.begin(false);
  return problems;
}

/// The job: checks every scene, and reports all errors. The exit code is 1 if there is an error.
Result check(const JobRun& run) {
  Result result{.tables = {{"problems"}}};
  for (const auto& files : scenes_of(run.args.texts("scene"))) {
    const Problems problems = problems_of(run, files);
    const std::string name = files.back().string();
    for (const std::string& message : problems.messages()) {
      result.tables[0].add("scene", name);
      result.tables[0].add("problem", message);
      result.errors.push_back(message);
    }
    const size_t count = problems.count();
    result.text += count == 0 ? fmt::format("{}: no errors\n", name)
                              : fmt::format("{}: {} error{}\n", name, count, count == 1 ? "" : "s");
    if (count > 0) result.code = 1;
  }
  return result;
}

}  // namespace

extern const JobInfo kCheckJob("check", "Scenes", "Read scenes and all files that they name, and report all errors.",
                               "Nothing is rendered. The exit status is 1 if there is an error.", kParams,
                               SessionUse::plugins, check);

}  // namespace frond
