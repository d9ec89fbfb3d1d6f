#include "system/temporary_name.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <mutex>
#include <regex>
#include <set>

namespace frond {
namespace {

namespace fs = std::filesystem;

bool is_temporary_name(const std::string& name) {
  static const std::regex pattern(R"(\.frond-\d+-\d+\.tmp)");
  return std::regex_match(name, pattern);
}

/// Whether `path` is still the name of the open file.
bool is_named(int file, const fs::path& path) {
  struct stat opened {
  }, named{};
  return fstat(file, &opened) == 0 && lstat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

/// Opens a file or a folder to lock it; -1 for other kinds. Files are opened for writing, because NFS makes an
/// exclusive lock of a lock for writing.
int open_for_locking(const fs::path& path) {
  const int file = open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  return file >= 0 || errno != EISDIR ? file : open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

}  // namespace

fs::path follow_links(const fs::path& path) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  return error ? path : target;
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

std::string temporary_name() {
  static std::atomic<uint64_t> count = 0;
  return fmt::format(".frond-{}-{}.tmp", getpid(), count++);
}

void remove_leftover_files(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  const std::lock_guard lock(mutex);
  if (!seen.insert(folder).second) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path path = entry->path();
    if (!is_temporary_name(path.filename().string())) continue;
    const int file = open_for_locking(path);
    if (file < 0) continue;
    std::error_code ignored;
    if (flock(file, LOCK_EX | LOCK_NB) == 0 && is_named(file, path)) fs::remove_all(path, ignored);
    close(file);
  }
}

bool lock_new(int descriptor, const fs::path& path) {
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  return is_named(descriptor, path);
}

}  // namespace frond
