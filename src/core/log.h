#pragma once

#include "core/error.h"

namespace frond {

/// Receiver of messages to the user. Callers use it from one thread at a time.
class Log {
 public:
  virtual ~Log() = default;
  virtual void info(std::string_view message) const = 0;
  /// Reports a warning about the input at `where`, which may be empty.
  virtual void warn(const Location& where, std::string_view message) const = 0;
};

/// Prints a line to standard error. A stream that is closed or full is no error: there is nowhere to report it.
/// Thread-safe.
void print_to_stderr(std::string_view text);

/// Log that prints to standard error; if `quiet`, warnings only, because a warning can say that numbers were changed.
/// Thread-safe.
class ConsoleLog final : public Log {
 public:
  explicit ConsoleLog(bool quiet = false) : quiet_(quiet) {}
  void info(std::string_view message) const override;
  void warn(const Location& where, std::string_view message) const override;

 private:
  bool quiet_;
};

/// Returns a log that discards all messages.
const Log& silent_log();

}  // namespace frond
