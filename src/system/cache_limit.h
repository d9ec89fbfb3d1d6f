#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/error.h"
#include "core/log.h"

namespace frond {

/// Files of one kind in the user's cache, NAME-HASH.EXTENSION with a hash of 16 hexadecimal digits, and what they may
/// take of the disk together.
struct CacheKind {
  std::string_view name;  ///< ends in '-'
  uintmax_t most_bytes;
};

/// Deletes files of the kind in the folder of `newest`, those that were not used for longest first, until all together
/// take no more than they may; never `newest` itself. Temporary files of runs that were killed go after a day. Tells
/// how many. Other processes may use and limit the folder at the same time.
void limit_cache(const std::filesystem::path& newest, const CacheKind& kind, const Log& log);

/// Counts as used now. A file that cannot be marked is left as it is.
void mark_as_used(const std::filesystem::path& file);

}  // namespace frond
