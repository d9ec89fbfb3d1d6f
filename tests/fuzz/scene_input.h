#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "tests/fuzz/fuzz.h"

namespace frond::fuzz {

/// Input of the scene targets: the text of a scene, and files that it can name. Each file begins after a line `#file
/// NAME`. Names of other characters than letters, digits, `_`, `-` and `.` are skipped, so that no file is written
/// outside the folder.
class SceneInput {
 public:
  explicit SceneInput(std::string_view bytes) {
    constexpr std::string_view kMark = "\n#file ";
    size_t mark = bytes.find(kMark);
    text_ = bytes.substr(0, mark);
    while (mark != bytes.npos) {
      bytes.remove_prefix(mark + kMark.size());
      mark = bytes.find(kMark);
      const std::string_view section = bytes.substr(0, mark);
      const size_t line = section.find('\n');
      const std::string name(section.substr(0, line));
      if (!is_plain(name)) continue;
      folder().write(name, line == section.npos ? std::string_view() : section.substr(line + 1));
      has_files_ = true;
    }
  }
  ~SceneInput() {
    if (has_files_) folder().clear();
  }
  SceneInput(const SceneInput&) = delete;
  SceneInput& operator=(const SceneInput&) = delete;

  const std::string& text() const { return text_; }
  static std::string name() { return (folder().path() / "scene.pbrt").string(); }

 private:
  static bool is_plain(std::string_view name) {
    return !name.empty() && name.size() < 100 && name[0] != '.' && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
             c == '.';
    });
  }

  std::string text_;
  bool has_files_ = false;
};

}  // namespace frond::fuzz
