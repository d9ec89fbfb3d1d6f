#include "system/cache_limit.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "core/log.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// File with the time of its last use (its modification time).
struct CachedFile {
  fs::path path;
  fs::file_time_type used;
  uintmax_t bytes;
};

/// Returns whether the name is one of this kind. The folder may contain other files, which must not be deleted.
bool is_cache_file(const CacheKind& kind, std::string_view file) {
  constexpr size_t kHashDigits = 16;
  if (!file.starts_with(kind.name)) return false;
  file.remove_prefix(kind.name.size());
  return file.find_first_not_of("0123456789abcdef") == kHashDigits && file[kHashDigits] == '.';
}

/// Returns whether a temporary file of replace_file, also of earlier versions, has this name.
bool is_temporary(const CacheKind& kind, std::string_view file) {
  return file.ends_with(".tmp") && (file.starts_with(".frond-") || is_cache_file(kind, file));
}

/// Files of one kind in a folder of the cache.
class Folder {
 public:
  /// Skips files that another process deletes meanwhile.
  Folder(const fs::path& folder, const CacheKind& kind) {
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
      const std::string name = i->path().filename().string();
      if (is_temporary(kind, name))
        add(*i, temporary_);
      else if (is_cache_file(kind, name))
        add(*i, kept_);
    }
    std::ranges::sort(kept_, std::greater(), &CachedFile::used);
  }

  /// Deletes temporary files older than a day: younger ones may belong to a running process.
  void delete_leftovers() {
    const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
    for (const CachedFile& file : temporary_)
      if (file.used < yesterday) remove(file);
  }
  /// Keeps `newest`, then the most recently used files up to the limit; deletes the others.
  void delete_beyond(uintmax_t most_bytes, const fs::path& newest) {
    std::error_code error;
    const uintmax_t newest_bytes = fs::file_size(newest, error);
    uintmax_t kept = error ? 0 : newest_bytes;
    for (const CachedFile& file : kept_) {
      if (file.path.filename() == newest.filename()) continue;
      kept += file.bytes;
      if (kept > most_bytes) remove(file);
    }
  }

  int deleted() const { return deleted_; }
  uintmax_t deleted_bytes() const { return deleted_bytes_; }

 private:
  static void add(const fs::directory_entry& entry, std::vector<CachedFile>& files) {
    std::error_code error;
    const auto used = entry.last_write_time(error);
    if (error) return;
    const uintmax_t bytes = entry.file_size(error);
    if (!error) files.push_back({entry.path(), used, bytes});
  }
  void remove(const CachedFile& file) {
    std::error_code error;
    if (fs::remove(file.path, error)) ++deleted_, deleted_bytes_ += file.bytes;
  }

  std::vector<CachedFile> kept_, temporary_;
  int deleted_ = 0;
  uintmax_t deleted_bytes_ = 0;
};

}  // namespace

void limit_cache(const fs::path& newest, const CacheKind& kind, const Log& log) {
  Folder folder(newest.parent_path(), kind);
  folder.delete_leftovers();
  folder.delete_beyond(kind.most_bytes, newest);
  if (folder.deleted() == 0) return;
  log.info(fmt::format("cache: deleted {} least recently used file{} {}*, {:.0f} MB; the limit is {:.1f} GB",
                       folder.deleted(), folder.deleted() > 1 ? "s" : "", kind.name,
                       double(folder.deleted_bytes()) * 1e-6, double(kind.most_bytes) * 1e-9));
}

void mark_as_used(const fs::path& file) {
  std::error_code error;
  fs::last_write_time(file, fs::file_time_type::clock::now(), error);
}

}  // namespace frond
