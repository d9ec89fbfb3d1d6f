#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/log.h"

namespace frond::leaf {

/// Cache files hold text with a checksum as its last line. Returns the path of the file in `folder` for the result that
/// `header` describes; empty if `folder` is empty: no cache.
std::filesystem::path cache_path(const std::filesystem::path& folder, std::string_view header,
                                 std::string_view extension);

/// Returns the text with its checksum appended.
std::string with_checksum(std::string text);
/// Returns the text before the checksum; empty if the checksum is missing or wrong.
std::string_view without_checksum(std::string_view text);

/// Reads a cache file; none if it does not exist. A file that cannot be read causes a warning.
std::optional<std::string> read_cached(const std::filesystem::path& path, const Log& log);
/// Writes a cache file and deletes the least recently used ones beyond the cache's limit (system/cache_limit.h). A
/// folder that cannot be written to causes a warning.
void write_cached(const std::filesystem::path& path, const std::string& text, const Log& log);

}  // namespace frond::leaf
