#include "system/new_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ranges>
#include <utility>

#include "core/error.h"
#include "system/atomic_file.h"
#include "system/file_uses.h"
#include "system/temporary_name.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void reject(const fs::path& path, const std::string& reason) {
  fail({}, "cannot write \"{}\": {}", path.string(), reason);
}

/// Returns the folder, or the nearest one above it that exists. Throws InputError if that is no folder.
fs::path nearest_existing(const fs::path& folder) {
  std::error_code error;
  fs::path found = folder;
  while (!fs::exists(fs::symlink_status(found, error))) {
    const fs::path above = folder_of(found);
    if (above == found) break;
    found = above;
  }
  if (!fs::is_directory(found, error))
    reject(folder, fmt::format("\"{}\" is a file, a folder is needed", found.string()));
  return found;
}

/// Without a separator at its end, so that a path above it is another folder.
fs::path without_trailing_separator(const fs::path& folder) {
  if (folder.empty()) return ".";
  return folder.has_filename() || folder == folder.root_path() ? folder : folder.parent_path();
}

}  // namespace

NewFiles::NewFiles(fs::path folder, std::vector<fs::path> inputs)
    : folder_(without_trailing_separator(folder)), inputs_(std::move(inputs)) {
  const fs::path base = nearest_existing(folder_);
  remove_leftover_files(base);
  for (int attempt = 0; lock_ < 0; ++attempt) {
    temporary_ = base / temporary_name();
    if (mkdir(temporary_.c_str(), 0777) != 0) {
      if (errno == EEXIST && attempt < 1000) continue;
      reject(folder_, std::strerror(errno));
    }
    lock_ = open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 && errno != ENOENT) {
      const int reason = errno;
      rmdir(temporary_.c_str());
      reject(folder_, std::strerror(reason));
    }
    if (lock_ >= 0 && !lock_new(lock_, temporary_)) close(std::exchange(lock_, -1));
  }
}

NewFiles::~NewFiles() {
  std::error_code error;
  fs::remove_all(temporary_, error);
  if (lock_ >= 0) close(lock_);
}

fs::path NewFiles::file(const std::string& name) {
  for (const fs::path& input : inputs_)
    if (is_same_file(input, folder_ / name))
      fail({}, "\"{}\" would replace the input \"{}\": write to another folder", (folder_ / name).string(),
           input.string());
  make_folders((temporary_ / name).parent_path());
  if (known_.insert(name).second) names_.push_back(name);
  return temporary_ / name;
}

fs::path NewFiles::folder(const std::string& name) {
  make_folders(temporary_ / name);
  folders_.push_back(name);
  return temporary_ / name;
}

void NewFiles::write(const std::string& name, std::span<const unsigned char> bytes) {
  NewFile file(this->file(name), folder_ / name);
  file.write(bytes);
  file.finish();
}

void NewFiles::write(const std::string& name, std::string_view text) {
  write(name, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

void NewFiles::check(const std::string& name) const {
  std::error_code error;
  const fs::path target = folder_ / name;
  const fs::path above = nearest_existing(target.parent_path());
  if (fs::equivalent(above, target.parent_path(), error)) return check_replaceable(target);
  if (access(above.c_str(), W_OK | X_OK) != 0) reject(target, std::strerror(errno));
}

/// Creates a folder and those above it that are missing, and records them.
void NewFiles::make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return;
  if (folder_of(folder) != folder) make_folder(folder_of(folder));
  if (mkdir(folder.c_str(), 0777) == 0)
    made_.push_back(folder);
  else if (errno != EEXIST)
    reject(folder, std::strerror(errno));
}

/// The old file and the new one change their names at once, where the file system can do this.
void NewFiles::move_into_place(const fs::path& from, const fs::path& target) {
  struct stat ignored {};
  if (lstat(target.c_str(), &ignored) != 0) {
    if (rename(from.c_str(), target.c_str()) != 0) reject(target, std::strerror(errno));
    placed_.push_back({target, ""});
    return;
  }
  fs::path old = from;  // where the exchange puts it
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0) {
    old = temporary_ / temporary_name();
    if (rename(target.c_str(), old.c_str()) != 0) reject(target, std::strerror(errno));
    if (rename(from.c_str(), target.c_str()) != 0) {
      const int reason = errno;
      rename(old.c_str(), target.c_str());
      reject(target, std::strerror(reason));
    }
  }
  placed_.push_back({target, old});
}

/// Latest first: a folder is empty by the time it is removed.
void NewFiles::roll_back() {
  for (const Placed& p : std::views::reverse(placed_))
    p.old.empty() ? unlink(p.target.c_str()) : rename(p.old.c_str(), p.target.c_str());
  for (const fs::path& folder : std::views::reverse(made_)) rmdir(folder.c_str());
}

/// Most failures are found before the first file has its name: a folder that has a file's name, a file in a folder's
/// place. A folder that does not exist gets its name with all its files at once.
void NewFiles::finish() {
  std::error_code error;
  for (const std::string& name : names_) check(name);
  try {
    if (!fs::exists(fs::symlink_status(folder_, error))) {
      if (folder_of(folder_) != folder_) make_folder(folder_of(folder_));
      if (rename(temporary_.c_str(), folder_.c_str()) != 0) reject(folder_, std::strerror(errno));
      return;
    }
    for (const std::string& name : folders_) make_folder(folder_ / name);
    for (const std::string& name : names_) {
      const fs::path target = follow_links(folder_ / name);
      make_folder(target.parent_path());
      move_into_place(temporary_ / name, target);
    }
  } catch (...) {
    roll_back();
    throw;
  }
}

}  // namespace frond
