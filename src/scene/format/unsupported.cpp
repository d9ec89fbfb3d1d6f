#include "scene/format/unsupported.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "scene/format/words.h"

namespace frond {

const std::vector<std::string_view>& Unsupported::kinds() {
  static const std::vector<std::string_view> all{"materials", "cameras", "textures", "films", "displacement"};
  return all;
}

/// Throws InputError for an unknown kind.
Unsupported::Unsupported(const std::string& kinds_given) {
  for (const std::string& kind : split(kinds_given, ',')) {
    if (kind == "all")
      passes_all_ = true;
    else if (std::ranges::find(kinds(), kind) != kinds().end())
      passing_.insert(kind);
    else
      fail({}, "--ignore-unsupported takes all, or some of {} with commas between; \"{}\" is none of them",
           fmt::join(kinds(), ", "), kind);
  }
}

void Unsupported::handle(std::string_view kind, const Location& where, std::string_view feature,
                         std::string_view instead, const Log& log) const {
  if (!is_ignored(kind))
    fail(where, "{} of pbrt-v4 is not supported; with --ignore-unsupported={} it {}", feature, kind, instead);
  log.warn(where, fmt::format("{} of pbrt-v4 is not supported: it {}", feature, instead));
}

}  // namespace frond
