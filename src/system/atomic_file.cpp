#include "system/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <utility>

#include "core/error.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
  fail({}, "cannot write \"{}\": {}", path.string(), std::strerror(error));
}

/// Returns the target of a symbolic link, else the path: renaming a file to a link would replace the link.
fs::path follow_links(const fs::path& path) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  return error ? path : target;
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

constexpr std::string_view kPrefix = ".frond-", kSuffix = ".tmp";

/// Deletes temporary files that killed processes have left in a folder. A process locks its own as long as it writes,
/// so that one whose lock can be taken has no writer, on this machine or another. Once for each folder.
void remove_left_files(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  const std::lock_guard lock(mutex);
  if (!seen.insert(folder).second) return;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) continue;
    const int file = open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    if (flock(file, LOCK_EX | LOCK_NB) == 0) unlink(entry.path().c_str());
    close(file);
  }
}

/// Locks a new file against remove_left_files. Returns false if that was faster. Without locks in a file system nothing
/// is removed there.
bool lock_new(int file) {
  if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  struct stat status {};
  return fstat(file, &status) != 0 || status.st_nlink > 0;
}

}  // namespace

NewFile::NewFile(const fs::path& path) : target_(follow_links(path)) {
  remove_left_files(folder_of(target_));
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    path_ = folder_of(target_) / fmt::format("{}{}-{}{}", kPrefix, getpid(), attempt, kSuffix);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) fail_to_write(target_, errno);
    if (descriptor_ >= 0 && !lock_new(descriptor_)) close(std::exchange(descriptor_, -1));
  }
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!path_.empty()) unlink(path_.c_str());
}

void NewFile::write(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_to_write(target_, errno);
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}

void NewFile::finish() {
  if (fsync(descriptor_) != 0) fail_to_write(target_, errno);
  const int descriptor = descriptor_;  // close releases it even if it fails
  descriptor_ = -1;
  if (close(descriptor) != 0) fail_to_write(target_, errno);
  if (rename(path_.c_str(), target_.c_str()) != 0) fail_to_write(target_, errno);
  path_.clear();
}

void make_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail({}, "cannot create folder \"{}\": {}", folder.string(), error.message());
}

void check_replaceable(const fs::path& path) {
  const fs::path target = follow_links(path), folder = folder_of(target);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail({}, "cannot write \"{}\": there is no folder \"{}\"", path.string(), folder.string());
  if (fs::is_directory(target, error)) fail({}, "cannot write \"{}\": it is a folder", path.string());
  if (fs::exists(target, error)) {
    if (!fs::is_regular_file(target, error)) fail({}, "cannot write \"{}\": it is no regular file", path.string());
    if (access(target.c_str(), W_OK) != 0) fail_to_write(path, errno);
  }
  const NewFile probe(target);  // fails if no file can be created in the folder
}

void replace_file(const fs::path& path, std::span<const unsigned char> bytes) {
  check_replaceable(path);
  NewFile file(path);
  file.write(bytes);
  file.finish();
}

}  // namespace frond
