#include "cli/common_options.h"

#include <charconv>
#include <cstdlib>

namespace frond {

std::filesystem::path cache_directory(const std::string& given, bool no_cache) {
  if (no_cache) return {};
  if (!given.empty()) return given;
  if (const char* base = std::getenv("XDG_CACHE_HOME"); base && *base) return std::filesystem::path(base) / "frond";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "frond";
  return {};
}

std::string is_seed(const std::string& text) {
  uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  return error == std::errc() && end == text.data() + text.size() ? "" : "a whole number from 0 to 2^64 - 1 is needed";
}

}  // namespace frond
