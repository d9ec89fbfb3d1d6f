#pragma once

#include <map>
#include <string>

#include "core/log.h"
#include "core/problems.h"

namespace frond {

/// Hands messages on. What is warned of at many places is told at the first, and then how many more there are; of
/// warnings that differ in names and numbers alone the first are. With --strict warnings are errors, which are
/// collected, place by place.
class StrictLog final : public Log {
 public:
  /// `to` must outlive it.
  StrictLog(const Log& to, bool is_strict) : to_(to), is_strict_(is_strict) {}
  ~StrictLog() override { tell_repeats(); }
  StrictLog(const StrictLog&) = delete;
  StrictLog& operator=(const StrictLog&) = delete;

  void info(std::string_view message) const override { to_.info(message); }
  void warn(const Location& where, std::string_view message) const override;
  /// Tells of what has been warned of again; throws the warnings there have been.
  void check() const;

 private:
  static constexpr size_t kMostAlike = 20;
  struct Warning {
    Location first;
    std::string message;
    size_t repeats = 0;
    size_t alike = 0;  ///< that are not told, from this one on
  };
  void tell_repeats() const;

  const Log& to_;
  bool is_strict_;
  mutable Problems problems_;
  mutable std::vector<Warning> warnings_;
  mutable std::map<std::string, size_t, std::less<>> by_message_;            ///< places in the warnings
  mutable std::map<std::string, std::vector<size_t>, std::less<>> by_kind_;  ///< of those told
};

}  // namespace frond
