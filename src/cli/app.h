#pragma once

#include <variant>
#include <vector>

#include "jobs/record/job.h"
#include "jobs/record/pbrt_options.h"

namespace frond {

/// A command line as the records of jobs read it.
struct ParsedCommand {
  const JobInfo* job;
  Arguments arguments;
  std::vector<const PbrtOption*> pbrt_options;  ///< of `frond render`: those of pbrt-v4 that frond has no use for
  bool asks_for_pbrt_help = false;              ///< --help-pbrt
};

/// The one place that knows CLI11. A number is the program's exit code: help, the version, or what is wrong has been
/// printed. Throws InputError for a value that a job's record refuses.
std::variant<ParsedCommand, int> parse_command_line(int argc, const char* const* argv);

}  // namespace frond
