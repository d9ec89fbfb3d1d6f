#pragma once

#include "core/error.h"
#include "core/log.h"

namespace frond {

/// For what is measured by itself: where something else than asked would be measured, that is an error.
class RefusingLog final : public Log {
 public:
  void info(std::string_view) const override {}
  void warn(const Location& where, std::string_view message) const override {
    throw InputError(where, std::string(message));
  }
};

}  // namespace frond
