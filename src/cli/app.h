#pragma once

#include <variant>
#include <vector>

#include "jobs/record/job.h"
#include "jobs/record/pbrt_options.h"

namespace frond {

/// A parsed command line: a job and its arguments.
struct ParsedCommand {
  const JobInfo* job;
  Arguments arguments;
  std::vector<const PbrtOption*> pbrt_options;  ///< given to `frond render`, without a function in frond
  bool asks_for_pbrt_help = false;              ///< --help-pbrt
};

/// Parses a command line; the only user of CLI11. Returns an exit code if help, the version or an error has been
/// printed. Throws InputError for a value that a job's record does not allow.
std::variant<ParsedCommand, int> parse_command_line(int argc, const char* const* argv);

}  // namespace frond
