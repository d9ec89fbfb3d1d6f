#pragma once

#include <gmock/gmock.h>

#include "tests/cli/command.h"
#include "tests/support/input_error.h"

namespace frond {

/// One of the instruments, with a soybean leaf in it.
class InstrumentCommand : public ::testing::Test {
 protected:
  explicit InstrumentCommand(std::string name) : name_(std::move(name)), folder_(name_) {}

  Outcome measure(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{name_, "abm,specimen=soybean", "--no-cache"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return frond_command(arguments);
  }
  /// Errors are reported before any ray: so many would take days.
  std::string refusal(std::vector<std::string> more) const {
    more.insert(more.end(), {"--rays", "1e15"});
    const Outcome o = measure(more);
    EXPECT_EQ(o.code, 1) << ::testing::PrintToString(more);
    EXPECT_THAT(o.out, ::testing::IsEmpty());
    return o.err;
  }
  std::string path(const std::string& file) const { return folder_.name_of(file); }

  std::string name_;
  TestFolder folder_;
};

}  // namespace frond
