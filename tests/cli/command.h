#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "cli/commands.h"

namespace frond {

/// Result of a command.
struct Outcome {
  int code;
  std::string out, err;
};

/// Runs the frond command in this process.
inline Outcome frond_command(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "frond");
  std::vector<const char*> argv;
  for (const std::string& a : arguments) argv.push_back(a.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int code = run(int(argv.size()), argv.data());
  std::fflush(stdout);
  return {code, ::testing::internal::GetCapturedStdout(), ::testing::internal::GetCapturedStderr()};
}

}  // namespace frond
