#include "imports/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include "core/error.h"
#include "system/atomic_file.h"

namespace frond {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(fs::path folder, std::vector<fs::path> inputs)
    : folder_(folder.empty() ? "." : std::move(folder)),
      temporary_(folder_ / fmt::format(".frond-import-{}.tmp", getpid())),
      inputs_(std::move(inputs)) {
  std::error_code error;
  if (!fs::is_directory(folder_, error)) fail({}, "there is no folder \"{}\"", folder_.string());
  make_folders(temporary_);
}

OutputFolder::~OutputFolder() {
  std::error_code error;
  fs::remove_all(temporary_, error);
}

fs::path OutputFolder::file(const std::string& name) {
  const fs::path target = folder_ / name;
  for (const fs::path& input : inputs_) {
    std::error_code error;
    if (fs::equivalent(input, target, error) && !error)
      fail({}, "the import would replace its input \"{}\": write the scene to another folder", input.string());
  }
  make_folders((temporary_ / name).parent_path());
  names_.push_back(name);
  return temporary_ / name;
}

void OutputFolder::write(const std::string& name, std::span<const unsigned char> bytes) {
  replace_file(file(name), bytes);
}

void OutputFolder::write(const std::string& name, const std::string& text) {
  write(name, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

/// All is on the disk by now; renaming fails only where a folder has a file's name.
void OutputFolder::finish() {
  for (const std::string& name : names_) {
    const fs::path target = folder_ / name;
    make_folders(target.parent_path());
    std::error_code error;
    fs::rename(temporary_ / name, target, error);
    if (error) fail({}, "cannot write \"{}\": {}", target.string(), error.message());
  }
}

}  // namespace frond
