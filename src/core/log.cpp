#include "core/log.h"

#include <cstdio>

namespace frond {

void ConsoleLog::info(std::string_view message) const {
  if (!quiet_) fmt::print(stderr, "{}\n", message);
}

void ConsoleLog::warn(const Location& where, std::string_view message) const {
  if (!quiet_) fmt::print(stderr, "{}warning: {}\n", where.text(), message);
}

const Log& silent_log() {
  static const ConsoleLog log(true);
  return log;
}

}  // namespace frond
