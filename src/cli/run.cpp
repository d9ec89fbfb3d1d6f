#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>

#include "cli/app.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/pbrt_options.h"
#include "cli/progress.h"
#include "core/messages/problems.h"
#include "render/checkpoint.h"
#include "render/parts/inputs.h"
#include "report/text_output.h"

namespace frond {
namespace {

/// Exit code when another process holds the lock of a part.
constexpr int kTryAgainLater = 75;  // EX_TEMPFAIL of sysexits.h

/// Stop signals are handled only if there is a file to save the partial result to.
bool saves_partial_result(const Arguments& args) {
  return (args.declares("checkpoint") && args.given("checkpoint")) || (args.declares("resume") && args.flag("resume"));
}

/// Whether a file is written to standard output, which then replaces the text.
bool writes_to_standard_output(const Arguments& args) {
  return std::ranges::any_of(args.params(), [&args](const JobParam* p) {
    return p->path == PathUse::write && args.given(p->name) && args.words(p->name).front() == "-";
  });
}

/// Returns the result of `act`; if it throws Stopped, a stopped result without content. Messages of other exceptions
/// name the plug-ins.
template <class Act>
Result run_guarded(const Log& log, std::span<const std::string> plugins, const Act& act) {
  try {
    return act();
  } catch (const Stopped&) {
    log.info("stopped; there is no partial result yet");
    return {.stopped = true};
  } catch (...) {
    rethrow_naming_plugins(plugins);
  }
}

/// Runs the job and prints its result. Returns the exit code.
int execute(const ParsedCommand& command) {
  const Arguments& args = command.arguments;
  const bool quiet = args.flag("quiet");
  const ConsoleLog console(quiet);
  for (const std::string& warning : pbrt_warnings(command.pbrt_options)) console.warn({}, warning);
  JobContext context(console, session_options(args));
  ProgressLine progress(quiet);
  std::optional<Interrupt> interrupt;
  if (saves_partial_result(args))
    interrupt.emplace();
  else if (args.declares("checkpoint"))
    advise_checkpoint_on_interrupt();
  RenderControl control{.progress = &progress};
  if (interrupt) control.stop = interrupt->token();
  const Result result = run_guarded(console, context.options().plugins, [&] {
    return run_job(*command.job, {context, args, control});
  });
  if (result.stopped) return 128 + (interrupt ? interrupt->signal() : 0);
  for (const std::string& error : result.errors) print_to_stderr("frond: " + error);
  if (result.is_requested || !(quiet || writes_to_standard_output(args))) write_text("-", result.text);
  return result.code;
}

}  // namespace

/// Errors are printed with the prefix "frond: "; of many errors at once, the first 20.
int run(int argc, const char* const* argv) {
  try {
    const auto parsed = parse_command_line(argc, argv);
    if (const int* code = std::get_if<int>(&parsed)) return *code;
    const auto& command = std::get<ParsedCommand>(parsed);
    if (!command.asks_for_pbrt_help) return execute(command);
    write_text("-", pbrt_options_text());
    return 0;
  } catch (const Busy& error) {
    print_to_stderr(fmt::format("frond: {}", error.what()));
    return kTryAgainLater;
  } catch (const InputErrors& errors) {
    constexpr size_t kMostShown = 20;
    print_to_stderr(errors.text("frond: ", kMostShown));
  } catch (const std::bad_alloc&) {
    print_to_stderr("frond: out of memory");
  } catch (const std::exception& error) {
    print_to_stderr(fmt::format("frond: {}", error.what()));
  } catch (...) {
    print_to_stderr("frond: a plug-in threw an object that is no std::exception");
  }
  return 1;
}

}  // namespace frond
