#include "scene/format/description.h"

#include <algorithm>

namespace frond {

namespace fs = std::filesystem;

/// Candidates are tried in order: first with the name as written, then with slashes for backslashes.
fs::path SceneSettings::resolve(const std::string& name, const Location& where) const {
  if (name.empty() || fs::path(name).is_absolute() || !where.file) return name;
  std::vector<fs::path> folders;
  const bool is_of_command_line = where.line == 0;
  if (!files.empty() && !is_of_command_line) folders.push_back(files.front().parent_path());
  folders.push_back(fs::path(*where.file).parent_path());
  if (!files.empty() && is_of_command_line) folders.push_back(files.front().parent_path());
  folders.emplace_back();
  std::string slashed = name;  // exporters on Windows write backslashes
  std::ranges::replace(slashed, '\\', '/');
  std::error_code error;
  for (const std::string& spelling : {name, slashed})
    for (const fs::path& folder : folders)
      if (fs::path path = (folder / spelling).lexically_normal(); fs::exists(path, error)) return path;
  return (folders.front() / name).lexically_normal();
}

}  // namespace frond
