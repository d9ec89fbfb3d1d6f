#include "imports/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <ranges>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "system/atomic_file.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".frond-import-", kSuffix = ".tmp";

int open_folder(const fs::path& folder) {
  return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/// Deletes the temporary folders of processes that were killed: those that no process has locked.
void remove_left_folders(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (const std::string name = entry->path().filename().string();
        name.starts_with(kPrefix) && name.ends_with(kSuffix))
      left.push_back(entry->path());
  for (const fs::path& path : left) {
    const int descriptor = open_folder(path);
    if (descriptor < 0) continue;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, error);
    close(descriptor);
  }
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder, std::vector<fs::path> inputs)
    : folder_(folder.empty() ? "." : std::move(folder)), inputs_(std::move(inputs)) {
  constexpr int kMostAttempts = 100;
  std::error_code error;
  if (!fs::is_directory(folder_, error)) fail({}, "there is no folder \"{}\"", folder_.string());
  remove_left_folders(folder_);
  for (int i = 0; lock_ < 0; ++i) {
    temporary_ = folder_ / fmt::format("{}{}-{}{}", kPrefix, getpid(), i, kSuffix);
    const bool is_new = fs::create_directory(temporary_, error);
    if (error || i == kMostAttempts) fail({}, "cannot create folder \"{}\": {}", temporary_.string(), error.message());
    if (!is_new) continue;
    lock_ = open_folder(temporary_);
    // Another process may take it for left, and delete it, until it is locked. Some file systems have no locks.
    const bool is_taken = lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (lock_ >= 0 && (is_taken || !fs::exists(temporary_, error))) close(std::exchange(lock_, -1));
  }
}

OutputFolder::~OutputFolder() {
  std::error_code error;
  fs::remove_all(temporary_, error);
  close(lock_);
}

fs::path OutputFolder::file(const std::string& name) {
  check_stop();
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

/// All is on the disk by now, so that renaming fails only where a folder has a file's name or a file a folder's, or by
/// a failure of the file system.
void OutputFolder::finish() {
  try {
    for (const std::string& name : names_) place(name);
  } catch (const InputError&) {
    restore();
    throw;
  }
}

void OutputFolder::place(const std::string& name) {
  const fs::path target = folder_ / name;
  std::error_code error;
  const bool is_new_folder = fs::create_directory(target.parent_path(), error);
  if (error) fail({}, "cannot create folder \"{}\": {}", target.parent_path().string(), error.message());
  if (is_new_folder) made_.push_back(target.parent_path());
  Placed placed{target, {}};
  if (fs::is_directory(target, error)) fail({}, "cannot write \"{}\": it is a folder", target.string());
  if (fs::exists(fs::symlink_status(target, error))) {
    placed.old = temporary_ / fmt::format("old-{}", placed_.size());
    fs::create_hard_link(target, placed.old, error);  // so that there is always one under the target's name
    if (error) fs::rename(target, placed.old, error);
    if (error) fail({}, "cannot write \"{}\": {}", target.string(), error.message());
  }
  placed_.push_back(placed);
  fs::rename(temporary_ / name, target, error);
  if (error) fail({}, "cannot write \"{}\": {}", target.string(), error.message());
}

/// In the reverse order; what fails here cannot be helped.
void OutputFolder::restore() noexcept {
  std::error_code error;
  for (const Placed& placed : placed_ | std::views::reverse) {
    if (placed.old.empty())
      fs::remove(placed.target, error);
    else
      fs::rename(placed.old, placed.target, error);
  }
  for (const fs::path& folder : made_ | std::views::reverse) fs::remove(folder, error);
}

}  // namespace frond
