#pragma once

#include "tests/support/command_test.h"

namespace frond {

/// One of the instruments, with a soybean leaf in it.
class InstrumentCommand : public CommandTest {
 protected:
  explicit InstrumentCommand(std::string name) : words_{std::move(name), "abm,specimen=soybean", "--no-cache"} {}

  Outcome measure(const Words& more) const { return frond_command(words_, more); }
  /// Errors are reported before any ray: so many would take days.
  std::string refusal(const Words& more) const { return refusal_of(words_, joined(more, {"--rays", "1e15"})); }

  Words words_;
};

}  // namespace frond
