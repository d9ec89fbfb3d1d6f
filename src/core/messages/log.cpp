#include "core/log.h"

#include <cstdio>

#include "core/messages/excerpt.h"

namespace frond {

namespace {

class SilentLog final : public Log {
 public:
  void info(std::string_view) const override {}
  void warn(const Location&, std::string_view) const override {}
};

}  // namespace

void print_to_stderr(std::string_view text) {
  const std::string line = fmt::format("{}\n", text);
  std::fwrite(line.data(), 1, line.size(), stderr);  // in one call, so that lines of threads do not mix
  std::fflush(stderr);
}

void ConsoleLog::info(std::string_view message) const {
  if (!quiet_) print_to_stderr(printable(message));
}

void ConsoleLog::warn(const Location& where, std::string_view message) const {
  print_to_stderr(InputError(where, fmt::format("warning: {}", message)).what());
}

const Log& silent_log() {
  static const SilentLog log;
  return log;
}

}  // namespace frond
