#include "leaf/table/cache_file.h"

#include "core/log.h"
#include "core/math/random.h"
#include "system/atomic_file.h"
#include "system/cache_limit.h"
#include "system/file_bytes.h"

namespace frond::leaf {
namespace {

constexpr CacheKind kLeafFiles{"leaf-", 1'000'000'000};
constexpr std::string_view kChecksum = "# checksum ";

std::string checksum_line(std::string_view text) { return fmt::format("{}{:016x}\n", kChecksum, hash_bytes(text)); }

}  // namespace

std::filesystem::path cache_path(const std::filesystem::path& folder, std::string_view header,
                                 std::string_view extension) {
  return folder.empty() ? folder : folder / fmt::format("{}{:016x}.{}", kLeafFiles.name, hash_bytes(header), extension);
}

std::string with_checksum(std::string text) { return text.append(checksum_line(text)); }

std::string_view without_checksum(std::string_view text) {
  const size_t body = text.rfind(kChecksum);
  if (body == std::string_view::npos || text.substr(body) != checksum_line(text.substr(0, body))) return {};
  return text.substr(0, body);
}

std::optional<std::string> read_cached(const std::filesystem::path& path, const Log& log) try {
  std::error_code error;  // a cache that cannot be accessed counts as empty
  if (path.empty() || !std::filesystem::is_regular_file(path, error)) return {};
  return read_file_bytes(path, {});
} catch (const InputError& error) {  // for example, another process has just deleted it
  log.warn({}, fmt::format("{}: its content is computed again", error.what()));
  return {};
}

void write_cached(const std::filesystem::path& path, const std::string& text, const Log& log) try {
  std::error_code error;  // the next line reports a missing folder
  std::filesystem::create_directories(path.parent_path(), error);
  replace_file(path, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  limit_cache(path, kLeafFiles, log);
} catch (const InputError& error) {
  log.warn({}, fmt::format("{}: the result is not cached", error.what()));
}

}  // namespace frond::leaf
