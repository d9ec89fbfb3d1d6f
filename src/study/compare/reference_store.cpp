#include "study/compare/reference_store.h"

#include <cstring>
#include <tuple>

#include "core/log.h"
#include "render/parts/part_file.h"
#include "system/atomic_file.h"
#include "system/cache_limit.h"
#include "system/file_bytes.h"

namespace frond::compare {
namespace {

constexpr CacheKind kReferences{"reference-", 2'000'000'000};

PartHeader header_of(const PairedRender& render, const Identity& identity) {
  PartHeader header;
  header.identity = identity;
  header.request = render.samples();
  header.statistics.wall_seconds = render.cost().wall_seconds;
  header.statistics.cpu_seconds = render.cost().cpu_seconds;
  header.statistics.rays = uint64_t(render.cost().rays);
  return header;
}

/// Serializes the size of the first film's part, that part, and the second film's part.
std::vector<unsigned char> encode(const PairedRender& render, const Identity& identity) {
  const PartHeader header = header_of(render, identity);
  const auto first = encode_part(header, render.film(0)), second = encode_part(header, render.film(1));
  const uint64_t size = first.size();
  std::vector<unsigned char> bytes(sizeof size);
  std::memcpy(bytes.data(), &size, sizeof size);
  bytes.insert(bytes.end(), first.begin(), first.end());
  bytes.insert(bytes.end(), second.begin(), second.end());
  return bytes;
}

bool is_like(const FilmFormat& a, const FilmFormat& b) {
  return a.settings.crop == b.settings.crop && a.bands == b.bands && a.exponent == b.exponent;
}

bool decode(std::string_view bytes, const std::filesystem::path& path, const Identity& identity,
            PairedRender& render) try {
  uint64_t size = 0;
  if (bytes.size() < sizeof size) return false;
  std::memcpy(&size, bytes.data(), sizeof size);
  bytes.remove_prefix(sizeof size);
  if (size > bytes.size()) return false;
  std::array<RenderPart, 2> parts{decode_part(bytes.substr(0, size), path), decode_part(bytes.substr(size), path)};
  for (const RenderPart& part : parts)
    if (part.header.identity != identity || !is_like(part.film.format(), render.film(0).format())) return false;
  const auto& [request, statistics] = std::tie(parts[0].header.request, parts[0].header.statistics);
  render.restore({std::move(parts[0].film), std::move(parts[1].film)}, request,
                 {statistics.wall_seconds, statistics.cpu_seconds, double(statistics.rays)});
  return true;
} catch (const InputError&) {
  return false;
}

}  // namespace

ReferenceStore::ReferenceStore(const std::filesystem::path& folder, Identity identity, const Log& log)
    : path_(folder.empty() ? folder : folder / fmt::format("{}{:016x}.bin", kReferences.name, identity.hash())),
      identity_(std::move(identity)),
      log_(log) {}

void ReferenceStore::load(PairedRender& render) const try {
  std::error_code error;  // an inaccessible cache counts as empty
  if (path_.empty() || !std::filesystem::is_regular_file(path_, error)) return;
  if (decode(read_file_bytes(path_, {}), path_, identity_, render))
    mark_as_used(path_);
  else
    log_.warn({}, fmt::format("{} is damaged: the reference is rendered anew", path_.string()));
} catch (const InputError& error) {  // another process may have just deleted the file
  log_.warn({}, fmt::format("{}: the reference is rendered anew", error.what()));
}

void ReferenceStore::save(const PairedRender& render) const {
  if (path_.empty()) return;
  const auto bytes = encode(render, identity_);
  try {
    std::filesystem::create_directories(path_.parent_path());
    replace_file(path_, bytes);
    limit_cache(path_, kReferences, log_);
  } catch (const std::exception& error) {
    log_.warn({}, fmt::format("the reference is not kept for next time: {}", error.what()));
  }
}

}  // namespace frond::compare
