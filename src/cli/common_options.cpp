#include "cli/common_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>

#include "cli/number_list.h"
#include "core/error.h"

namespace frond {
namespace {

/// Nothing before and behind it, no sign unless T has one.
template <class T>
bool is_whole(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::filesystem::path cache_directory(const std::string& given, bool no_cache) {
  if (no_cache) return {};
  if (!given.empty()) return given;
  if (const char* base = std::getenv("XDG_CACHE_HOME"); base && *base) return std::filesystem::path(base) / "frond";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "frond";
  return {};
}

std::string is_seed(const std::string& text) {
  return is_whole<uint64_t>(text) ? "" : "a whole number from 0 to 2^64 - 1 is needed";
}

std::string is_pixel(const std::string& text) {
  return is_whole<int>(text) && text[0] != '-' ? "" : "whole numbers of pixels from 0 on are needed";
}

std::string is_number(const std::string& text) { return finite_number(text) ? "" : "a number is needed"; }

std::string is_positive(const std::string& text) {
  return finite_number(text).value_or(0) > 0 ? "" : "a number above 0 is needed";
}

std::function<std::string(const std::string&)> is_within(Interval range) {
  return [range](const std::string& text) {
    const auto value = finite_number(text);
    return value && range.contains(*value) ? std::string()
                                           : fmt::format("a number from {:g} to {:g} is needed", range.min, range.max);
  };
}

void add_plugin_option(CLI::App& command, std::vector<std::string>& files) {
  command
      .add_option(
          "--plugin", files,
          "Shared object with further plugins; may be given again. Those in the folders of FROND_PLUGIN_PATH are "
          "loaded by themselves.")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

CLI::Option* add_count_option(CLI::App& command, const std::string& name, int& value, int most,
                              const std::string& doc) {
  const auto set = [name, &value, most](const std::string& text) {
    value = static_cast<int>(parse_count(name, text, 1, most));
  };
  return command.add_option_function<std::string>(name, set, doc)->type_name("INT");
}

}  // namespace frond
