#pragma once

#include <cstdint>
#include <filesystem>

#include "core/error.h"

namespace frond::compare {

/// What references may take of the user's disk.
inline constexpr uintmax_t kMostCachedBytes = 2'000'000'000;

/// Deletes references in the folder of `newest`, those that were not used for longest first, until all together take no
/// more than `most_bytes`; never `newest` itself. Tells how many.
void limit_references(const std::filesystem::path& newest, uintmax_t most_bytes, const Log& log);

/// Counts as used now. A file that cannot be marked is left as it is.
void mark_as_used(const std::filesystem::path& file);

}  // namespace frond::compare
