#include "system/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

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

}  // namespace

NewFile::NewFile(const fs::path& path) : target_(follow_links(path)) {
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    path_ = folder_of(target_) / fmt::format(".frond-{}-{}.tmp", getpid(), attempt);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) fail_to_write(target_, errno);
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
