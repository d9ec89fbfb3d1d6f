#pragma once

#include "jobs/record/job.h"

/// What help, man pages, completion and docs/commands.md call commands and their parameters.
namespace frond {

inline constexpr JobParam kHelpParam("help", ArgumentKind::flag, "Print this help message and exit.", {.aliases = "h"});
inline constexpr JobParam kVersionParam("version", ArgumentKind::flag, "Display program version information and exit.");
/// Of frond render.
inline constexpr JobParam kHelpPbrtParam("help-pbrt", ArgumentKind::flag,
                                         "Print the options of pbrt-v4 that have no effect, or are refused.");

/// The parameters of a command, or of frond itself.
struct CommandParams {
  std::string name;                        ///< "" for frond itself
  std::vector<const JobParam*> arguments;  ///< positional
  std::vector<const JobParam*> options;
};
CommandParams command_params(const JobInfo& job);
CommandParams frond_params();

/// Names of an option with their dashes: "-o", "--output", "--outfile".
std::vector<std::string> option_names(const JobParam& param);
/// What an option's value is called: FILE, INT; "" for a flag.
std::string value_name(const JobParam& param);
/// "frond brf [OPTIONS] scene"; an optional argument is in brackets.
std::string usage(const JobInfo& job);
/// Without its full stop.
std::string first_sentence(std::string_view doc);

}  // namespace frond
