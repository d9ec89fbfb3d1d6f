#pragma once

#include <string>
#include <vector>

#include "jobs/job.h"

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

/// Adds a subcommand for each job, made from its record.
std::vector<Command> add_commands(CLI::App& app);

/// Names of an option with their dashes: "-o", "--output", "--outfile"; none of a positional one.
std::vector<std::string> option_names(const JobParam& param);
/// What help calls an option's value: FILE, INT; "" for a flag.
std::string value_name(const JobParam& param);

}  // namespace frond
