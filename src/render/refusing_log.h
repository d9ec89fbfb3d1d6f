#pragma once

#include "core/error.h"
#include "core/log.h"

namespace frond {

/// Log that discards information and throws warnings as InputError. Measurements use it: a warning means that the
/// material deviates from what was requested, and then the measurement would be of another material.
class RefusingLog final : public Log {
 public:
  void info(std::string_view) const override {}
  void warn(const Location& where, std::string_view message) const override {
    throw InputError(where, std::string(message));
  }
};

}  // namespace frond
