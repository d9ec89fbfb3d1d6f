#include "cli/compare/reference_store.h"

#include <cstring>
#include <type_traits>

#include "core/atomic_file.h"
#include "core/cache_limit.h"
#include "core/file_bytes.h"
#include "core/random.h"

namespace frond::compare {
namespace {

static_assert(std::is_trivially_copyable_v<Film::Pixel> && std::is_trivially_copyable_v<Film::BandSums>);

constexpr CacheKind kReferences{"reference-", 2'000'000'000};

/// The file: this, the pixels and bands of the first film, of the second, and a hash of all that. In the machine's own
/// order of bytes: it is a cache of this machine.
struct Header {
  char magic[16] = "frond reference";
  uint64_t identity = 0, samples = 0, pixels = 0, pixel_bytes = sizeof(Film::Pixel);
  uint64_t bands = 0, band_bytes = sizeof(Film::BandSums);
  RenderCost cost;
};
static_assert(std::is_trivially_copyable_v<Header>);

Header header_of(const PairedRender& render, uint64_t identity) {
  return {.identity = identity,
          .samples = render.samples(),
          .pixels = render.film(0).pixels().size(),
          .bands = render.film(0).band_sums().size(),
          .cost = render.cost()};
}

template <class Sums>
void append(std::string& bytes, std::span<const Sums> sums) {
  bytes.append(reinterpret_cast<const char*>(sums.data()), sums.size_bytes());
}

/// Takes them off the front of `bytes`.
template <class Sums>
std::vector<Sums> take(std::string_view& bytes, size_t count) {
  std::vector<Sums> sums(count);
  if (count > 0) std::memcpy(sums.data(), bytes.data(), count * sizeof(Sums));
  bytes.remove_prefix(count * sizeof(Sums));
  return sums;
}

std::string encode(const PairedRender& render, uint64_t identity) {
  const Header header = header_of(render, identity);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  for (const size_t half : {size_t{0}, size_t{1}}) {
    append(bytes, render.film(half).pixels());
    append(bytes, render.film(half).band_sums());
  }
  const uint64_t hash = hash_bytes(bytes);
  return bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
}

bool like(const Header& a, const Header& b) {
  return std::memcmp(a.magic, b.magic, sizeof a.magic) == 0 && a.identity == b.identity && a.pixels == b.pixels &&
         a.pixel_bytes == b.pixel_bytes && a.bands == b.bands && a.band_bytes == b.band_bytes;
}

bool decode(std::string_view bytes, uint64_t identity, PairedRender& render) {
  const Header expected = header_of(render, identity);
  const size_t body =
      sizeof expected + 2 * (expected.pixels * expected.pixel_bytes + expected.bands * expected.band_bytes);
  Header header;
  uint64_t hash = 0;
  if (bytes.size() != body + sizeof hash) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::memcpy(&hash, bytes.data() + body, sizeof hash);
  if (!like(header, expected) || hash != hash_bytes(bytes.substr(0, body))) return false;
  bytes.remove_prefix(sizeof header);
  std::array<FilmSums, 2> films;
  for (FilmSums& film : films) {
    film.pixels = take<Film::Pixel>(bytes, expected.pixels);
    film.bands = take<Film::BandSums>(bytes, expected.bands);
  }
  render.restore(films, header.samples, header.cost);
  return true;
}

}  // namespace

ReferenceStore::ReferenceStore(const std::filesystem::path& folder, uint64_t identity, const Log& log)
    : path_(folder.empty() ? folder : folder / fmt::format("{}{:016x}.bin", kReferences.name, identity)),
      identity_(identity),
      log_(log) {}

void ReferenceStore::load(PairedRender& render) const try {
  std::error_code error;  // a cache that cannot be looked into is none
  if (path_.empty() || !std::filesystem::is_regular_file(path_, error)) return;
  if (decode(read_file_bytes(path_, {}), identity_, render))
    mark_as_used(path_);
  else
    log_.warn({}, fmt::format("{} is damaged: the reference is rendered anew", path_.string()));
} catch (const InputError& error) {  // another process may have deleted it just now
  log_.warn({}, fmt::format("{}: the reference is rendered anew", error.what()));
}

void ReferenceStore::save(const PairedRender& render) const {
  if (path_.empty()) return;
  const std::string bytes = encode(render, identity_);
  try {
    std::filesystem::create_directories(path_.parent_path());
    replace_file(path_, {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
    limit_cache(path_, kReferences, log_);
  } catch (const std::exception& error) {
    log_.warn({}, fmt::format("the reference is not kept for next time: {}", error.what()));
  }
}

}  // namespace frond::compare
