#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/error.h"
#include "core/log.h"

namespace frond {

/// Kind of files in the user's cache: their names are NAME-HASH.EXTENSION with a hash of 16 hexadecimal digits, and
/// their total size is limited.
struct CacheKind {
  std::string_view name;  ///< beginning of the file names, which ends in '-'
  uintmax_t most_bytes;   ///< largest total size
};

/// Deletes files of the kind in the folder of `newest`, least recently used first, until their total size is within the
/// limit; `newest` itself is kept. Also deletes temporary files of killed processes that are older than a day. Logs the
/// number of deleted files. Other processes may use and limit the folder at the same time.
void limit_cache(const std::filesystem::path& newest, const CacheKind& kind, const Log& log);

/// Sets a file's modification time, which orders the deletion, to now. Errors are ignored.
void mark_as_used(const std::filesystem::path& file);

}  // namespace frond
