#include "imports/file_in.h"

#include <algorithm>
#include <stdexcept>

#include "system/lower_case.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns the one file beside `path` whose name differs from it by the case of letters; otherwise nothing.
fs::path in_other_case(const fs::path& path) {
  fs::path found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path.parent_path(), error)) {
    if (lower_case(entry.path().filename().string()) != lower_case(path.filename().string())) continue;
    if (!found.empty()) return {};
    found = entry.path();
  }
  return found;
}

}  // namespace

fs::path file_in(const fs::path& folder, std::string name) {
  std::ranges::replace(name, '\\', '/');
  std::error_code error;
  fs::path path = fs::canonical(folder / name, error);
  if (error) path = fs::canonical(in_other_case(folder / name), error);
  if (error) throw std::runtime_error("there is no such file");
  if (std::ranges::mismatch(folder, path).in1 != folder.end())
    throw std::runtime_error("it is outside the model's folder; put it there and change the path in the model");
  if (!fs::is_regular_file(path, error)) throw std::runtime_error("it is no regular file");
  return path;
}

}  // namespace frond
