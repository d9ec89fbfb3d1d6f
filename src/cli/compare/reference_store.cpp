#include "cli/compare/reference_store.h"

#include <cstring>
#include <type_traits>

#include "core/random.h"
#include "scene/atomic_file.h"
#include "scene/file_bytes.h"

namespace frond::compare {
namespace {

static_assert(std::is_trivially_copyable_v<Film::Pixel>);

/// The file: this, the pixels of the first film, of the second, and a hash of all that. In the machine's own order of
/// bytes: it is a cache of this machine.
struct Header {
  char magic[16] = "frond reference";
  uint64_t identity = 0, samples = 0, pixels = 0, pixel_bytes = sizeof(Film::Pixel);
  RenderCost cost;
};
static_assert(std::is_trivially_copyable_v<Header>);

std::string encode(const PairedRender& render, uint64_t identity) {
  const Header header{.identity = identity,
                      .samples = render.samples(),
                      .pixels = render.film(0).pixels().size(),
                      .cost = render.cost()};
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  for (const size_t half : {size_t{0}, size_t{1}}) {
    const auto pixels = render.film(half).pixels();
    bytes.append(reinterpret_cast<const char*>(pixels.data()), pixels.size_bytes());
  }
  const uint64_t hash = hash_bytes(bytes);
  return bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
}

bool decode(const std::string& bytes, uint64_t identity, PairedRender& render) {
  Header header, expected;
  const size_t pixels = render.film(0).pixels().size(), film_bytes = pixels * sizeof(Film::Pixel);
  const size_t body = sizeof header + 2 * film_bytes;
  uint64_t hash = 0;
  if (bytes.size() != body + sizeof hash) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::memcpy(&hash, bytes.data() + body, sizeof hash);
  if (std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0 || header.identity != identity ||
      header.pixels != pixels || header.pixel_bytes != sizeof(Film::Pixel) || hash != hash_bytes({bytes.data(), body}))
    return false;
  std::array<std::vector<Film::Pixel>, 2> films{std::vector<Film::Pixel>(pixels), std::vector<Film::Pixel>(pixels)};
  for (size_t i = 0; i < 2; ++i)
    std::memcpy(films[i].data(), bytes.data() + sizeof header + i * film_bytes, film_bytes);
  render.restore({films[0], films[1]}, header.samples, header.cost);
  return true;
}

}  // namespace

ReferenceStore::ReferenceStore(const std::filesystem::path& folder, uint64_t identity, const Log& log)
    : path_(folder.empty() ? folder : folder / fmt::format("reference-{:016x}.bin", identity)),
      identity_(identity),
      log_(log) {}

void ReferenceStore::load(PairedRender& render) const {
  std::error_code error;  // a cache that cannot be looked into is none
  if (path_.empty() || !std::filesystem::is_regular_file(path_, error)) return;
  if (!decode(read_file_bytes(path_, {}), identity_, render))
    log_.warn({}, fmt::format("{} is damaged: the reference is rendered anew", path_.string()));
}

void ReferenceStore::save(const PairedRender& render) const {
  if (path_.empty()) return;
  const std::string bytes = encode(render, identity_);
  try {
    std::filesystem::create_directories(path_.parent_path());
    replace_file(path_, {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
  } catch (const std::exception& error) {
    log_.warn({}, fmt::format("the reference is not kept for next time: {}", error.what()));
  }
}

}  // namespace frond::compare
