#pragma once

#include <filesystem>
#include <string>

namespace frond {

/// Where computed tables are kept: the folder given, else the user's cache; empty where there is none or `no_cache`.
std::filesystem::path cache_directory(const std::string& given, bool no_cache);

/// A check for CLI11, which alone lets -1 and 10^30 become the largest number: "" for a seed, else what is needed.
std::string is_seed(const std::string& text);

}  // namespace frond
