#include "cli/reading_options.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "core/problems.h"
#include "scene/parser.h"

namespace frond {
namespace {

constexpr const char* kIgnore = "--ignore-unsupported";

bool are_kinds(const std::string& word) {
  try {
    (void)Unsupported(word);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool is_scene_name(const std::string& word) {
  return word.ends_with(".pbrt") || word.ends_with(".pbrt.gz") || word == "-";
}

/// Case, dashes and underscores do not count, as in pbrt.
std::string normalized(std::string_view name) {
  std::string result;
  for (const char c : name)
    if (c != '-' && c != '_') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// "-NThreads=2" as "--nthreads=2"; any other word as it is.
std::string with_our_name(const std::string& word, const CLI::App& command) {
  const std::string_view all = word;
  const size_t name_end = std::min(all.find('='), all.size());
  if (!all.starts_with('-') || name_end < 3) return word;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (normalized(name) == normalized(all.substr(0, name_end)))
        return "--" + name + std::string(all.substr(name_end));
  return word;
}

}  // namespace

void add_reading_options(CLI::App& command, ReadingOptions& options) {
  command.add_flag(std::string(kIgnore) + "{all}", options.ignore_unsupported,
                   fmt::format("Leave out what there is of pbrt-v4 but not here, or take what is nearest, with a "
                               "warning: all of it, or --ignore-unsupported=KINDS, some of {}.",
                               fmt::join(Unsupported::kinds(), ",")));
  command.add_flag("--strict", options.strict, "Warnings are errors.");
}

Unsupported unsupported_of(const ReadingOptions& o) {
  return o.ignore_unsupported.empty() ? Unsupported() : Unsupported(o.ignore_unsupported);
}

std::vector<std::vector<std::filesystem::path>> scenes_of(const std::vector<std::string>& files) {
  std::vector<std::vector<std::filesystem::path>> scenes;
  bool is_open = false;  // the last scene has no world yet
  for (const std::string& file : files) {
    if (!is_open) scenes.emplace_back();
    scenes.back().emplace_back(file);
    is_open = files.size() > 1 && !holds_world(file);
  }
  return scenes;
}

std::vector<std::string> with_pbrt_spelling(std::vector<std::string> words, const CLI::App& render) {
  if (!words.empty() && (words[0].starts_with('-') || is_scene_name(words[0])) &&
      std::ranges::any_of(words, is_scene_name)) {
    for (std::string& word : words) word = with_our_name(word, render);
    words.insert(words.begin(), render.get_name());
  }
  for (size_t i = 1; i < words.size(); ++i)
    if (words[i - 1] == kIgnore && are_kinds(words[i])) {
      words[i - 1] += "=" + words[i];
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
    }
  return words;
}

}  // namespace frond
