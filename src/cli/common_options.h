#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/spectrum.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace frond {

/// Where computed tables are kept: the folder given, else the user's cache; empty where there is none or `no_cache`.
std::filesystem::path cache_directory(const std::string& given, bool no_cache);

/// `--plugin FILE`, which may be given again.
void add_plugin_option(CLI::App& command, std::vector<std::string>& files);

/// A number of things, from 1 to `most`, that may be written 1e3.
CLI::Option* add_count_option(CLI::App& command, const std::string& name, int& value, int most, const std::string& doc);

// Checks for CLI11: "" for what is right, else what is needed. Its own print ranges of doubles with hundreds of digits.

std::string is_number(const std::string& text);
std::string is_positive(const std::string& text);
/// A pixel's place.
std::string is_pixel(const std::string& text);
std::function<std::string(const std::string&)> is_within(Interval range);

/// CLI11 alone lets -1 and 10^30 become the largest number.
std::string is_seed(const std::string& text);

}  // namespace frond
