#pragma once

#include <optional>
#include <string>
#include <vector>

namespace frond {

struct ChildResult {
  int status = 0;  ///< 0: well
  std::string out, err;
};

/// Runs a program, found along PATH, with `input` on its standard input. Nothing where there is no such program. Throws
/// InputError for any other reason that it cannot be run.
std::optional<ChildResult> run_child(const std::vector<std::string>& command, const std::string& input);

}  // namespace frond
