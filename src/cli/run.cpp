#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/commands.h"
#include "cli/mistyped.h"
#include "cli/reading_options.h"
#include "core/problems.h"
#include "render/checkpoint.h"

namespace frond {

namespace {

constexpr int kTryAgainLater = 75;  // EX_TEMPFAIL of sysexits.h

/// Also prints help, which CLI11 takes for an error. A word that nothing is called by is told first: CLI11 would miss
/// what that word was meant to be.
int refuse(const CLI::App& app, const CLI::ParseError& error) {
  const std::string message = error.get_exit_code() == 0 ? "" : mistyped(app);
  if (message.empty()) return app.exit(error) == 0 ? 0 : 1;
  fmt::print(stderr, "frond: {}\n", message);
  return 1;
}

}  // namespace

int run(int argc, const char* const* argv) {
  CLI::App app{"frond: a spectral path tracer for plant leaves.", "frond"};
  app.set_version_flag("--version", "frond " FROND_VERSION);
  app.require_subcommand(1);
  add_render_command(app);
  add_check_command(app);
  add_merge_command(app);
  add_submit_command(app);
  add_compare_command(app);
  add_convert_command(app);
  add_difference_command(app);
  add_list_command(app);
  add_describe_command(app);
  add_table_command(app);
  add_fit_command(app);
  add_brf_command(app);
  add_flux_command(app);
  add_canopy_command(app);
  add_instances_command(app);
  add_conform_command(app);
  add_spectrophotometer_command(app);
  add_goniophotometer_command(app);
  add_export_command(app);
  add_bench_command(app);
  add_man_command(app);
  add_completion_command(app);
  try {
    std::vector<std::string> words = with_pbrt_spelling({argv + 1, argv + argc}, *app.get_subcommand("render"));
    std::ranges::reverse(words);  // CLI11 takes them from the end
    app.parse(std::move(words));
    return 0;
  } catch (const CLI::RuntimeError& verdict) {  // a command's own exit code; it has said why
    return verdict.get_exit_code();
  } catch (const CLI::ParseError& error) {
    return refuse(app, error);
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
