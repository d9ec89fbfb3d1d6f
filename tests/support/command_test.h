#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "tests/support/input_error.h"

namespace frond {

using Words = std::vector<std::string>;

/// Exit code and output of a command.
struct Outcome {
  int code;
  std::string out, err;
};

inline Words joined(Words first, const Words& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Runs `frond words... more...` in this process.
inline Outcome frond_command(const Words& words, const Words& more = {}) {
  const Words all = joined(joined({"frond"}, words), more);
  std::vector<const char*> argv;
  for (const std::string& word : all) argv.push_back(word.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int code = run(int(argv.size()), argv.data());
  std::fflush(stdout);
  return {code, ::testing::internal::GetCapturedStdout(), ::testing::internal::GetCapturedStderr()};
}

/// The message of a command that must fail and print nothing to standard output.
inline std::string refusal_of(const Words& words, const Words& more = {}) {
  const Outcome o = frond_command(words, more);
  EXPECT_EQ(o.code, 1) << ::testing::PrintToString(words) << ::testing::PrintToString(more) << o.err;
  EXPECT_THAT(o.out, ::testing::IsEmpty());
  return o.err;
}

/// Base of the tests of commands: each has a folder for its files.
class CommandTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.name_of(name); }

  TestFolder folder_{"command"};
};

}  // namespace frond
