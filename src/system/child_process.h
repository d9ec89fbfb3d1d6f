#pragma once

#include <optional>
#include <string>
#include <vector>

namespace frond {

/// Result of a program that has ended.
struct ChildResult {
  int status = 0;        ///< as from waitpid; 0: success
  std::string out, err;  ///< standard output and standard error
};

/// Runs a program, which is searched for in PATH, with `input` as its standard input, and waits until it ends. Returns
/// nothing if there is no such program. Throws InputError if it cannot be run for any other reason.
std::optional<ChildResult> run_child(const std::vector<std::string>& command, const std::string& input);

}  // namespace frond
