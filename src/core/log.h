#pragma once

#include "core/error.h"

namespace frond {

/// Where messages to the user go. Called from one thread at a time.
class Log {
 public:
  virtual ~Log() = default;
  virtual void info(std::string_view message) const = 0;
  /// `where` may be empty: then the message stands alone.
  virtual void warn(const Location& where, std::string_view message) const = 0;
};

/// Standard error, or nothing when quiet. Messages of several threads stay whole.
class ConsoleLog final : public Log {
 public:
  explicit ConsoleLog(bool quiet = false) : quiet_(quiet) {}
  void info(std::string_view message) const override;
  void warn(const Location& where, std::string_view message) const override;

 private:
  bool quiet_;
};

/// Says nothing to anyone.
const Log& silent_log();

}  // namespace frond
