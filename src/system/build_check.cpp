#include "system/build_check.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

namespace frond {

std::string build_mismatch(const BuildRecord& record) {
  if (const std::string_view theirs = record.standard_library; theirs != FROND_STANDARD_LIBRARY)
    return fmt::format("was compiled with {}, this frond with {}", theirs, FROND_STANDARD_LIBRARY);
  if (record.headers == record.headers_end)
    return "does not say which headers it was compiled from: build it with CMake's target frond::plugin, or from the "
           "headers that frond installs";
  std::set<std::string> others;
  for (const char* at = record.headers; at < record.headers_end;) {
    const std::string_view entry(at);  // entries are padded with zeros to their alignment
    at += entry.size() + 1;
    if (entry.empty()) continue;
    const std::string_view path = entry.substr(0, entry.find(' '));
    const std::string_view hash = entry.substr(std::min(entry.size(), path.size() + 1));
    const auto own = own_headers().find(path);
    if (own == own_headers().end())
      others.insert(fmt::format("{}, which frond lacks", path));
    else if (own->second != hash)
      others.emplace(path);
  }
  if (others.empty()) return "";
  constexpr size_t kMostNamed = 5;
  const std::vector<std::string> named(others.begin(),
                                       std::next(others.begin(), ptrdiff_t(std::min(kMostNamed, others.size()))));
  const std::string more = others.size() > kMostNamed ? fmt::format("; and {} more", others.size() - kMostNamed) : "";
  return fmt::format("was compiled from other headers than this frond ({}{})", fmt::join(named, "; "), more);
}

}  // namespace frond
