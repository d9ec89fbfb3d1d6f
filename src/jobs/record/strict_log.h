#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/problems.h"

namespace frond {

/// A log that passes messages on to another one, each warning once: a warning that is repeated at many places is shown
/// at the first, then how often it was repeated; of warnings that differ in names and numbers alone the first 20 are
/// shown. In strict mode warnings are errors, which are collected.
class StrictLog final : public Log {
 public:
  /// `to` must outlive it.
  explicit StrictLog(const Log& to) : to_(to) {}
  ~StrictLog() override { show_repeats(); }
  StrictLog(const StrictLog&) = delete;
  StrictLog& operator=(const StrictLog&) = delete;

  /// Forgets earlier warnings; from now on warnings are errors if `is_strict`.
  void begin(bool is_strict);
  void info(std::string_view message) const override { to_.info(message); }
  void warn(const Location& where, std::string_view message) const override;
  /// Shows what was repeated; throws the warnings of strict mode.
  void check() const;
  /// The log that messages are passed on to: a warning there is none of the scene's, so never an error.
  const Log& target() const { return to_; }

 private:
  static constexpr size_t kMostAlike = 20;
  struct Warning {
    Location first;
    std::string message;
    size_t repeats = 0;
    size_t alike = 0;  ///< warnings like this one that are not shown
  };
  void show_repeats() const;

  const Log& to_;
  bool is_strict_ = false;
  mutable Problems problems_;
  mutable std::vector<Warning> warnings_;
  mutable std::map<std::string, size_t, std::less<>> by_message_;            ///< places in the warnings
  mutable std::map<std::string, std::vector<size_t>, std::less<>> by_kind_;  ///< of those shown
};

}  // namespace frond
