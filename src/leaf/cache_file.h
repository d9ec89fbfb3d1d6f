#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace frond::leaf {

/// Files that keep results: text with a checksum as its last line.

std::string with_checksum(std::string text);
/// The text before the checksum; empty where that is missing or wrong.
std::string_view without_checksum(std::string_view text);

/// Empty where it cannot be read.
std::string read_file(const std::filesystem::path& path);
/// Never leaves half a file under the final name.
bool write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace frond::leaf
