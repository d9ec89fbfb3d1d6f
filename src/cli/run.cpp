#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "cli/app.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/mistyped.h"
#include "cli/pbrt_options.h"
#include "cli/progress.h"
#include "core/problems.h"
#include "render/checkpoint.h"
#include "report/text_output.h"

namespace frond {
namespace {

constexpr int kTryAgainLater = 75;  // EX_TEMPFAIL of sysexits.h

constexpr const char* kExamples =
    "Examples:\n"
    "  frond render scenes/soybean-front/scene.pbrt --wavelengths smpte -o leaf.png\n"
    "  frond compare scenes/soybean-front/scene.pbrt --quick -o report\n"
    "frond COMMAND --help prints the options of a command.\n"
    "frond SCENE.pbrt is short for frond render SCENE.pbrt.";

/// Also prints help, which CLI11 takes for an error. An unknown word is reported first: CLI11 would report what that
/// word was meant to be as missing.
int refuse(const CLI::App& app, const CLI::ParseError& error) {
  const std::string message = error.get_exit_code() == 0 ? "" : mistyped(app);
  if (message.empty()) return app.exit(error) == 0 ? 0 : 1;
  fmt::print(stderr, "frond: {}\n", message);
  return 1;
}

bool asks_for_parts(const Arguments& args) {
  return (args.declares("checkpoint") && args.given("checkpoint")) || (args.declares("resume") && args.flag("resume"));
}

/// Data goes to standard output in place of text.
bool writes_to_standard_output(const Arguments& args) {
  return std::ranges::any_of(args.params(), [&args](const JobParam* p) {
    return p->path == PathUse::write && args.given(p->name) && args.words(p->name).front() == "-";
  });
}

int execute(const Command& command) {
  const Arguments args = command.arguments();
  const bool quiet = args.flag("quiet");
  const ConsoleLog console(quiet);
  if (command.job->name == "render")
    for (const std::string& warning : pbrt_warnings(*command.app)) console.warn({}, warning);
  JobContext context(console, session_options(args));
  ProgressLine progress(quiet);
  std::optional<Interrupt> interrupt;
  if (asks_for_parts(args)) interrupt.emplace();
  RenderControl control{.progress = &progress};
  if (interrupt) control.stop = interrupt->token();
  const Result result = run_job(*command.job, {context, args, control});
  if (result.stopped) return 128 + (interrupt ? interrupt->signal() : 0);
  for (const std::string& error : result.errors) fmt::print(stderr, "frond: {}\n", error);
  if (result.is_requested || !(quiet || writes_to_standard_output(args))) write_text("-", result.text);
  return result.code;
}

int parse_and_execute(CLI::App& app, const std::vector<Command>& commands, int argc, const char* const* argv) {
  std::vector<std::string> words = with_pbrt_spelling({argv + 1, argv + argc}, *app.get_subcommand("render"));
  std::ranges::reverse(words);  // CLI11 takes them from the end
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return refuse(app, error);
  }
  const auto chosen = std::ranges::find_if(commands, [](const Command& c) { return c.app->parsed(); });
  if (chosen->job->name == "render" && chosen->app->count("--help-pbrt") > 0) {
    write_text("-", pbrt_options_text());
    return 0;
  }
  return execute(*chosen);
}

}  // namespace

int run(int argc, const char* const* argv) {
  CLI::App app{"frond: a spectral path tracer for plant leaves.", "frond"};
  app.set_version_flag("--version", "frond " FROND_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  try {
    return parse_and_execute(app, add_commands(app), argc, argv);
  } catch (const Busy& error) {
    fmt::print(stderr, "frond: {}\n", error.what());
    return kTryAgainLater;
  } catch (const InputErrors& errors) {
    constexpr size_t kMostShown = 20;
    fmt::print(stderr, "{}\n", errors.text("frond: ", kMostShown));
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "frond: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "frond: {}\n", error.what());
  }
  return 1;
}

}  // namespace frond
