#include "system/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"
#include "system/temporary_name.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
  fail({}, "cannot write \"{}\": {}", path.string(), std::strerror(error));
}

/// Link of an open file in /proc, by which it gets a name.
std::string link_of(int file) { return fmt::format("/proc/self/fd/{}", file); }

/// Opens a file without a name, which disappears if the process ends. Returns -1 where the file system has none.
int open_nameless(const fs::path& folder) {
  const int file = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (file >= 0 && access(link_of(file).c_str(), F_OK) == 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  if (file >= 0) close(file);
  return -1;
}

/// Whether the path names a device or an open stream, such as /dev/stdout: a file of this name would replace the
/// stream's file.
bool is_stream(const fs::path& path) {
  std::error_code error;
  const std::string folder = fs::canonical(folder_of(path), error).string();
  return !error && (folder == "/dev" || folder.starts_with("/proc/"));
}

}  // namespace

NewFile::NewFile(const fs::path& path, const fs::path& shown)
    : target_(follow_links(path)), shown_(shown.empty() ? target_ : shown) {
  remove_leftover_files(folder_of(target_));
  descriptor_ = open_nameless(folder_of(target_));
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    path_ = folder_of(target_) / temporary_name();
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) fail_to_write(shown_, errno);
    if (descriptor_ >= 0 && !lock_new(descriptor_, path_)) close(std::exchange(descriptor_, -1));
  }
}

NewFile::~NewFile() {
  if (!path_.empty()) unlink(path_.c_str());
  if (descriptor_ >= 0) close(descriptor_);
}

void NewFile::write(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_to_write(shown_, errno);
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}

/// The lock is held until the file has its name. A file without a name cannot replace another one: it gets a temporary
/// name first.
void NewFile::finish() {
  if (fsync(descriptor_) != 0) fail_to_write(shown_, errno);
  while (path_.empty()) {
    const fs::path name = folder_of(target_) / temporary_name();
    if (linkat(AT_FDCWD, link_of(descriptor_).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
      path_ = name;
    else if (errno != EEXIST)
      fail_to_write(shown_, errno);
  }
  if (rename(path_.c_str(), target_.c_str()) != 0) fail_to_write(shown_, errno);
  path_.clear();
  close(std::exchange(descriptor_, -1));
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
    if (!fs::is_regular_file(target, error) || is_stream(path))
      fail({}, "cannot write \"{}\": it is no regular file", path.string());
    if (access(target.c_str(), W_OK) != 0) fail_to_write(path, errno);
  }
  if (error) fail_to_write(path, error.value());  // such as a name that is too long
  const NewFile probe(target);                    // fails if no file can be created in the folder
}

void replace_file(const fs::path& path, std::span<const unsigned char> bytes) {
  check_replaceable(path);
  NewFile file(path);
  file.write(bytes);
  file.finish();
}

}  // namespace frond
