#pragma once

#include <string>
#include <vector>

#include "jobs/record/job.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace frond {

/// A job as a subcommand.
struct Command {
  const JobInfo* job;
  CLI::App* app;
  std::vector<std::pair<const JobParam*, CLI::Option*>> options;

  /// What the command line says. Throws InputError.
  Arguments arguments() const;
};

/// Adds a subcommand for each job, made from its record. Help is wrapped at the width of the terminal.
std::vector<Command> add_commands(CLI::App& app);

}  // namespace frond
