#include "system/file_time.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "core/error.h"

namespace frond {

std::time_t file_time() {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  if (!epoch || !*epoch) return std::time(nullptr);
  const std::string_view text(epoch);
  std::time_t seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  constexpr std::time_t kLastOfYear9999 = 253402300799;
  if (error != std::errc() || end != text.data() + text.size() || seconds < 0 || seconds > kLastOfYear9999)
    fail({}, "SOURCE_DATE_EPOCH is \"{}\", seconds since 1970 are needed", text);
  return seconds;
}

}  // namespace frond
