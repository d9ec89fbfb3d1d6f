#include "scene/format/description.h"

#include <algorithm>

#include "core/messages/excerpt.h"

namespace frond {

namespace fs = std::filesystem;

namespace {

/// Returns the existing file of a path, without "..", or nullopt. As in pbrt, the system resolves "..": after a
/// symbolic link to a folder it is the parent of the link's target. If no such file exists, ".." is the folder with the
/// link.
std::optional<fs::path> existing(const fs::path& path) {
  std::error_code error;
  const fs::path normal = path.lexically_normal();
  if (normal == path || !fs::exists(path, error))
    return fs::exists(normal, error) ? std::optional(normal) : std::nullopt;
  return fs::equivalent(path, normal, error) ? normal : fs::canonical(path, error);
}

/// Whether the file, wherever links lead, lies outside the folder.
bool is_outside(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(file, error);
  const fs::path real_folder = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  return std::ranges::mismatch(real_folder, real).in1 != real_folder.end();
}

/// Candidates are tried in order: first with the name as written, then with slashes for backslashes.
fs::path found(const SceneSettings& scene, const std::string& name, const Location& where) {
  if (name.empty() || fs::path(name).is_absolute() || !where.file) return name;
  const auto& files = scene.files;
  std::vector<fs::path> folders;
  const bool is_of_command_line = where.line == 0;
  if (!files.empty() && !is_of_command_line) folders.push_back(files.front().parent_path());
  folders.push_back(fs::path(*where.file).parent_path());
  if (!files.empty() && is_of_command_line) folders.push_back(files.front().parent_path());
  folders.emplace_back();
  std::string slashed = name;  // exporters on Windows write backslashes
  std::ranges::replace(slashed, '\\', '/');
  for (const std::string& spelling : {name, slashed})
    for (const fs::path& folder : folders)
      if (const auto path = existing(folder / spelling)) return *path;
  // "FILE:COLUMN", a column of a table of spectra.
  if (const size_t colon = slashed.rfind(':'); colon != slashed.npos && colon > 0)
    for (const fs::path& folder : folders)
      if (const auto path = existing(folder / slashed.substr(0, colon))) return path->string() + slashed.substr(colon);
  return (folders.front() / name).lexically_normal();
}

}  // namespace

void InstanceList::add(uint32_t object, const SceneTransform& map) {
  const PreciseTransform::Rows& rows = map.precise.rows();
  if (precise.empty() && is_far({rows[0][3], rows[1][3], rows[2][3]})) {
    for (const AffineMap& before : *maps) precise.push_back(precise_rows(before));
    precise.push_back(rows);
  } else if (!precise.empty()) {
    precise.push_back(rows);
  }
  maps->push_back({map.rows()});
  objects.push_back(object);
}

/// The scene's folder is the folder of its main file. Files that the command line names are trusted, wherever they lie.
fs::path SceneSettings::resolve(const std::string& name, const Location& where) const {
  fs::path path = found(*this, name, where);
  if (!where.file || where.line == 0) return path;
  const fs::path& main = files.empty() ? fs::path(*where.file) : files.front();
  if (is_outside(main.parent_path(), path)) mark_foreign(path);
  return path;
}

}  // namespace frond
