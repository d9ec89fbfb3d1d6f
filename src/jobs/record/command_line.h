#pragma once

#include "jobs/record/job.h"

/// Names of commands and parameters in help, man pages, completion and docs/commands.md.
namespace frond {

inline constexpr JobParam kHelpParam("help", ArgumentKind::flag, "Print this help message and exit.", {.aliases = "h"});
inline constexpr JobParam kVersionParam("version", ArgumentKind::flag, "Display program version information and exit.");
/// Option of `frond render`.
inline constexpr JobParam kHelpPbrtParam("help-pbrt", ArgumentKind::flag,
                                         "Print the options of pbrt-v4 that have no effect, or are refused.");

/// Parameters of a command, or of `frond` itself.
struct CommandParams {
  std::string name;                        ///< "" for frond itself
  std::vector<const JobParam*> arguments;  ///< positional
  std::vector<const JobParam*> options;
};
/// Returns all parameters of the job, and --help.
CommandParams command_params(const JobInfo& job);
/// Returns the options of `frond` itself: --help, --version.
CommandParams frond_params();

/// Returns an option's names with dashes: "-o", "--output", "--outfile".
std::vector<std::string> option_names(const JobParam& param);
/// Returns the name of an option's value: FILE, INT; "" for a flag.
std::string value_name(const JobParam& param);
/// Returns the usage line, "frond brf [OPTIONS] scene"; optional arguments are in brackets.
std::string usage(const JobInfo& job);
/// Returns the first sentence of `doc` without its full stop.
std::string first_sentence(std::string_view doc);

}  // namespace frond
