#pragma once

#include "core/log.h"
#include "core/problems.h"

namespace frond {

/// Hands messages on; with --strict warnings are errors, which are collected.
class StrictLog final : public Log {
 public:
  /// `to` must outlive it.
  StrictLog(const Log& to, bool is_strict) : to_(to), is_strict_(is_strict) {}

  void info(std::string_view message) const override { to_.info(message); }
  void warn(const Location& where, std::string_view message) const override {
    if (is_strict_)
      problems_.add(InputError(where, std::string(message) + " (--strict)"));
    else
      to_.warn(where, message);
  }
  /// Throws the warnings there have been.
  void check() const { problems_.check(); }

 private:
  const Log& to_;
  bool is_strict_;
  mutable Problems problems_;
};

}  // namespace frond
