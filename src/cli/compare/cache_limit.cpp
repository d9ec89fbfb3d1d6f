#include "cli/compare/cache_limit.h"

#include <algorithm>
#include <vector>

namespace frond::compare {
namespace {

struct CachedFile {
  std::filesystem::path path;
  std::filesystem::file_time_type used;
  uintmax_t bytes;
};

bool is_reference(const std::filesystem::path& path) {
  return path.filename().string().starts_with("reference-") && path.extension() == ".bin";
}

/// The last used first. Files that another program deletes meanwhile are left out.
std::vector<CachedFile> references_in(const std::filesystem::path& folder) {
  std::vector<CachedFile> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    std::error_code gone;
    const auto used = entry.last_write_time(gone);
    const uintmax_t bytes = gone ? 0 : entry.file_size(gone);
    if (!gone && is_reference(entry.path())) files.push_back({entry.path(), used, bytes});
  }
  std::ranges::sort(files, std::greater(), &CachedFile::used);
  return files;
}

}  // namespace

void limit_references(const std::filesystem::path& newest, uintmax_t most_bytes, const Log& log) {
  std::error_code error;
  uintmax_t kept = std::filesystem::file_size(newest, error), deleted = 0;
  int count = 0;
  for (const CachedFile& file : references_in(newest.parent_path())) {
    if (file.path == newest) continue;
    kept += file.bytes;
    if (kept <= most_bytes || !std::filesystem::remove(file.path, error)) continue;
    ++count, deleted += file.bytes;
  }
  if (count > 0)
    log.info(fmt::format("cache: {} reference{} that lay unused for longest deleted, {:.0f} MB; {:.1f} GB may stay",
                         count, count > 1 ? "s" : "", double(deleted) * 1e-6, double(most_bytes) * 1e-9));
}

void mark_as_used(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), error);
}

}  // namespace frond::compare
