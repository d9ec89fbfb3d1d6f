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

/// Log that prints to standard error, or nothing if `quiet`. Thread-safe: each message is printed in one call.
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
