#include "cli/pbrt_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "jobs/record/pbrt_options.h"
#include "scene/format/unsupported.h"

namespace frond {
namespace {

constexpr const char* kIgnore = "--ignore-unsupported";

/// Whether the word is a list of kinds for --ignore-unsupported, and not the next argument.
bool is_kind_list(const std::string& word) {
  try {
    (void)Unsupported(word);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Removes dashes and underscores and ignores case, as pbrt-v4 does.
std::string normalized(std::string_view name) {
  std::string result;
  for (const char c : name)
    if (c != '-' && c != '_') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Returns an option in frond's spelling: "-NThreads=2" becomes "--nthreads=2". Other words are returned unchanged.
std::string to_frond_spelling(const std::string& word, const std::vector<std::string>& names) {
  const std::string_view all = word;
  const size_t name_end = std::min(all.find('='), all.size());
  if (!all.starts_with('-') || name_end < 3) return word;
  for (const std::string& name : names)
    if (normalized(name) == normalized(all.substr(0, name_end))) return "--" + name + std::string(all.substr(name_end));
  return word;
}

}  // namespace

std::string pbrt_options_text() {
  std::string text = "Options of pbrt-v4 that frond render ignores with a warning, or refuses:\n";
  for (const PbrtOption& o : kPbrtOptions)
    text +=
        fmt::format("  {:<32} {}{}\n", fmt::format("{} {}", o.name, o.value), o.is_refused ? "Refused: " : "", o.doc);
  return text;
}

std::vector<std::string> pbrt_warnings(const std::vector<const PbrtOption*>& given) {
  std::vector<std::string> warnings;
  for (const PbrtOption* o : given) {
    if (o->is_refused) fail({}, "{}: {}", o->name, o->doc);
    const std::string_view name = o->name;
    if (name != "--stats" && name != "--render-coord-sys")
      warnings.push_back(fmt::format("{} of pbrt has no effect here", o->name));
  }
  return warnings;
}

bool is_scene_name(const std::string& word) {
  return word.ends_with(".pbrt") || word.ends_with(".pbrt.gz") || word == "-";
}

/// Options are translated only if a scene file is given without a command, as pbrt is called.
std::vector<std::string> translate_pbrt_options(std::vector<std::string> words, const std::vector<std::string>& names) {
  if (!words.empty() && (words[0].starts_with('-') || is_scene_name(words[0])) &&
      std::ranges::any_of(words, is_scene_name)) {
    for (std::string& word : words) word = to_frond_spelling(word, names);
    words.insert(words.begin(), "render");
  }
  for (size_t i = 1; i < words.size(); ++i)
    if (words[i - 1] == kIgnore && is_kind_list(words[i])) {
      words[i - 1] += "=" + words[i];
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
    }
  return words;
}

}  // namespace frond
