#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/log.h"

namespace frond::leaf {

/// Files that keep results: text with a checksum as its last line.

/// Where the cache in `folder` keeps what `header` describes; empty where that is empty: nothing is kept.
std::filesystem::path cache_path(const std::filesystem::path& folder, std::string_view header,
                                 std::string_view extension);

std::string with_checksum(std::string text);
/// The text before the checksum; empty where that is missing or wrong.
std::string_view without_checksum(std::string_view text);

/// None where there is no such file. One that cannot be read costs a warning.
std::optional<std::string> read_cached(const std::filesystem::path& path, const Log& log);
/// Makes room for it where files lie unused (system/cache_limit.h). A folder that does not take it costs a warning.
void write_cached(const std::filesystem::path& path, const std::string& text, const Log& log);

}  // namespace frond::leaf
