#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/messages/problems.h"

namespace frond {

/// A log that forwards messages to another log and limits repetition. A repeated warning is shown once, followed by its
/// count; of warnings that differ only in names and numbers, the first kMostAlike are shown. In strict mode warnings
/// are collected as errors.
class StrictLog final : public Log {
 public:
  /// `to` must outlive this object.
  explicit StrictLog(const Log& to) : to_(to) {}
  ~StrictLog() override { show_repeats(); }
  StrictLog(const StrictLog&) = delete;
  StrictLog& operator=(const StrictLog&) = delete;

  /// Forgets earlier warnings; subsequent warnings are errors if `is_strict`.
  void begin(bool is_strict);
  void info(std::string_view message) const override { to_.info(message); }
  void warn(const Location& where, std::string_view message) const override;
  /// Logs the counts of repeated warnings. Throws the collected warnings of strict mode.
  void check() const;
  /// Returns the number of warnings since begin(), including those that are not shown; 0 in strict mode.
  size_t warnings() const { return count_; }
  /// Returns the log that messages are forwarded to. Warnings sent to it directly are never errors.
  const Log& target() const { return to_; }

 private:
  static constexpr size_t kMostAlike = 20;
  struct Warning {
    Location first;
    std::string message;
    size_t repeats = 0;
    size_t alike = 0;  ///< number of similar warnings that are not shown
  };
  void show_repeats() const;

  const Log& to_;
  bool is_strict_ = false;
  mutable size_t count_ = 0;
  mutable Problems problems_;
  mutable std::vector<Warning> warnings_;
  mutable std::map<std::string, size_t, std::less<>> by_message_;            ///< message to index in warnings_
  mutable std::map<std::string, std::vector<size_t>, std::less<>> by_kind_;  ///< kind_of(message) to indices
};

}  // namespace frond
