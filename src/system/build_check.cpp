#include "system/build_check.h"

#include <fmt/ranges.h>

#include <set>

namespace frond {

std::string mismatch(const BuildRecord& record) {
  if (const std::string_view theirs = record.standard_library; theirs != FROND_STANDARD_LIBRARY)
    return fmt::format("was compiled with {}, this frond with {}", theirs, FROND_STANDARD_LIBRARY);
  if (record.headers == record.headers_end)
    return "does not say which headers it was compiled from: build it with CMake's target frond::plugin, or from the "
           "headers that frond installs";
  std::set<std::string_view> others;
  for (const char* at = record.headers; at < record.headers_end;) {
    const std::string_view entry(at);  // there are zeros between entries, as many as their alignment asks for
    at += entry.size() + 1;
    if (entry.empty()) continue;
    const std::string_view path = entry.substr(0, entry.find(' '));
    const auto own = own_headers().find(path);
    if (own == own_headers().end() || own->second != entry.substr(path.size() + 1)) others.insert(path);
  }
  if (others.empty()) return "";
  return fmt::format("was compiled from other headers than this frond ({})", fmt::join(others, ", "));
}

}  // namespace frond
