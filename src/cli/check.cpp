#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/reading_options.h"
#include "cli/strict_log.h"
#include "image/image_file.h"
#include "render/session.h"

namespace frond {
namespace {

struct CheckOptions {
  std::vector<std::string> scenes, plugins;
  ReadingOptions reading;
};

/// All that is wrong with a scene; nothing is rendered.
Problems problems_of(const std::vector<std::filesystem::path>& files, const CheckOptions& o) {
  const ConsoleLog console;
  const StrictLog log(console, o.reading.strict);
  Session session(log, {.plugins = o.plugins});
  Problems problems;
  const SceneDescription description = session.read(files, unsupported_of(o.reading), problems);
  if (!description.files.empty()) problems.attempt([&] { session.check(description); });
  problems.attempt([&] { check_picture_name(session.film(description).filename, description.film.where); });
  problems.attempt([&] { log.check(); });
  return problems;
}

int check(const CheckOptions& o) {
  bool is_right = true;
  for (const auto& files : scenes_of(o.scenes)) {
    const Problems problems = problems_of(files, o);
    for (const std::string& message : problems.messages()) fmt::print(stderr, "frond: {}\n", message);
    const std::string name = files.back().string();
    if (problems.empty())
      fmt::print("{}: nothing is wrong\n", name);
    else
      fmt::print("{}: {} error{}\n", name, problems.count(), problems.count() == 1 ? "" : "s");
    is_right = is_right && problems.empty();
  }
  return is_right ? 0 : 1;
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  auto* command = app.add_subcommand(
      "check", "Read scenes and all that they name, tell everything that is wrong, and render nothing.");
  command->add_option("scene", options->scenes, "Scene files.")->type_name("SCENE")->required();
  add_reading_options(*command, options->reading);
  add_plugin_option(*command, options->plugins);
  command->callback([options] {
    const int code = check(*options);
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace frond
