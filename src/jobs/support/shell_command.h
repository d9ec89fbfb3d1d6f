#pragma once

#include <string>

#include "jobs/record/job.h"

namespace frond {

/// Returns a word for a POSIX shell, quoted if necessary.
std::string shell_word(const std::string& word);
/// Returns the given arguments as a command that can be pasted into a POSIX shell in the same folder.
std::string pasted_command(const JobInfo& job, const Arguments& args);

}  // namespace frond
