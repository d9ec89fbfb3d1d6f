#include "render/parts/part_file.h"

#include <zstd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/error.h"
#include "core/math/random.h"
#include "system/atomic_file.h"
#include "system/file_bytes.h"

static_assert(std::endian::native == std::endian::little, "parts are kept in this order of bytes");

namespace frond {

using Json = nlohmann::ordered_json;

/// The arrays of a tile, which are stored as in memory.
class PartFile {
 public:
  static_assert(std::has_unique_object_representations_v<FilmTile::Pixel>, "no byte of a file is left to chance");
  static_assert(std::has_unique_object_representations_v<FilmTile::BandSums>);
  static_assert(std::has_unique_object_representations_v<FilmTile::WeightedSums>);
  static_assert(std::has_unique_object_representations_v<FilmTile::BandSplat>);
  static_assert(sizeof(FilmTile::Hits) == 24);

  /// Calls each(pointer, bytes) for every array.
  template <class Tile, class Each>
  static void for_each_array(Tile& tile, const Each& each) {
    const auto array = [&each](auto& values) { each(values.data(), values.size() * sizeof(values[0])); };
    array(tile.pixels_);
    array(tile.bands_);
    array(tile.hits_);
    array(tile.mean_sums_);
    array(tile.ids_);
    array(tile.splats_);
    array(tile.band_splats_);
    if (!tile.first_half_.empty()) each(&tile.first_half_paths_, sizeof tile.first_half_paths_);
    array(tile.first_half_);
    each(&tile.rays_, sizeof tile.rays_);
  }
  /// Mattes are lists of any length.
  static std::vector<MatteList>& mattes(FilmTile& tile) { return tile.mattes_; }
  static const std::vector<MatteList>& mattes(const FilmTile& tile) { return tile.mattes_; }
  /// True if the numbers of samples are possible ones of the tile's coverage.
  static bool has_counts_of_coverage(const FilmTile& tile) {
    uint64_t samples = 0;
    for (const FilmTile::Pixel& pixel : tile.pixels_) {
      if (pixel.samples > tile.paths()) return false;
      samples += pixel.samples;
    }
    return samples == tile.paths() && tile.first_half_paths_ <= samples;
  }
};

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "frond part 4\n", kEnd = "frond part end\n";

[[noreturn]] void fail_to_read(const fs::path& path, std::string_view why) {
  fail({}, "\"{}\" {}: render it again", path.string(), why);
}

// --- header

/// Throws the exception that a reader reports as damage.
[[noreturn]] void reject(const Json& json, const char* why) { throw Json::other_error::create(501, why, &json); }

/// Returns an integer of at most `most`. A forged header can hold any number, and conversions do not check.
template <class Integer>
Integer integer_of(const Json& json, Integer most = std::numeric_limits<Integer>::max()) {
  if (!json.is_number_unsigned() || json.get<uint64_t>() > uint64_t(most)) reject(json, "no number that it can be");
  return static_cast<Integer>(json.get<uint64_t>());
}

constexpr int kMostPixels = 1 << 24;  ///< in a row or a column
constexpr size_t kMostBands = 1 << 16;
constexpr int kMostExponent = 2048;
constexpr double kMostWeight = 1e6;  // of a filter; usual ones are about 1
constexpr int kMostRounds = 1 << 20;
constexpr uint64_t kMostSamples = uint64_t{1} << 40;  ///< of a pixel

Json json_of(const Crop& c) { return {c.x0, c.y0, c.x1, c.y1}; }
Crop crop_of(const Json& j) {
  // Pixels around a crop, whose samples reach into it, can have negative coordinates.
  const auto bound = [&j](size_t i) {
    const Json& value = j.at(i);
    if (!value.is_number_integer() || (value.is_number_unsigned() && value.get<uint64_t>() > uint64_t(kMostPixels)) ||
        value.get<int64_t>() < -kMostPixels)
      reject(value, "no position of a pixel");
    return static_cast<int>(value.get<int64_t>());
  };
  return {bound(0), bound(1), bound(2), bound(3)};
}

Json json_of(const std::vector<Band>& bands) {
  Json list = Json::array();
  for (const Band& band : bands) {
    Json points = Json::array();
    for (const ResponsePoint& p : band.response) points.push_back({p.nm, p.value});
    list.push_back({{"nm", band.nm}, {"response", points}, {"name", band.name}});
  }
  return list;
}
std::vector<Band> bands_of(const Json& list) {
  std::vector<Band> bands;
  for (const Json& j : list) {
    Band& band = bands.emplace_back(Band{j.at("nm")});
    for (const Json& p : j.at("response")) band.response.push_back({p.at(0), p.at(1)});
    band.name = j.at("name");
  }
  return bands;
}

Json json_of(const std::optional<Splatting>& s) {
  if (!s) return {};
  Json axes = Json::array();
  for (const SplatAxis& axis : s->axes)
    axes.push_back({{"reach", axis.reach}, {"mean", axis.mean}, {"square", axis.square}});
  return {{"sampled", json_of(s->sampled)},
          {"axes", axes},
          {"has_negative_weights", s->has_negative_weights},
          {"correlated_pixels", s->correlated_pixels}};
}
std::optional<Splatting> splatting_of(const Json& j, const Crop& crop) {
  if (j.is_null()) return {};
  Splatting s;
  for (size_t i = 0; i < 2; ++i) {
    const Json& axis = j.at("axes").at(i);
    s.axes[i] = {integer_of<int>(axis.at("reach"), kMostReach), axis.at("mean").get<std::vector<double>>(),
                 axis.at("square").get<std::vector<double>>()};
    const auto width = size_t(2 * s.axes[i].reach + 1);
    if (s.axes[i].mean.size() != width || s.axes[i].square.size() != width) reject(j, "a filter of another width");
    const auto is_weight = [](double weight) { return std::abs(weight) <= kMostWeight; };
    if (!std::ranges::all_of(s.axes[i].mean, is_weight) || !std::ranges::all_of(s.axes[i].square, is_weight))
      reject(j, "a filter whose weights are too large");
  }
  s.has_negative_weights = j.at("has_negative_weights"), s.correlated_pixels = j.at("correlated_pixels");
  if (!(s.correlated_pixels >= 1 && s.correlated_pixels <= kMostWeight)) reject(j, "no number of pixels");
  s.sampled = crop_of(j.at("sampled"));
  if (intersection(s.sampled, crop) != crop ||
      intersection(s.sampled, widened(crop, s.reach_x(), s.reach_y())) != s.sampled)
    reject(j, "samples of other pixels");
  return s;
}

Json json_of(const FilmFormat& f) {
  const FilmSettings& s = f.settings;
  return {{"width", s.width},
          {"height", s.height},
          {"crop", json_of(s.crop)},
          {"half", s.half},
          {"exposure", s.exposure},
          {"max_component", std::isinf(s.max_component) ? Json() : Json(s.max_component)},  // JSON has no infinity
          {"bands", f.bands},
          {"buckets_nm", f.has_buckets() ? Json{s.buckets_nm.min, s.buckets_nm.max} : Json()},
          {"channels", f.channels.names()},
          {"means", f.channels.means()},
          {"ids", f.channels.ids()},
          {"halves", f.halves},
          {"exponent", f.exponent},
          {"color", f.color.row},
          {"white", f.white},
          {"splatting", json_of(f.splatting)}};
}
FilmFormat film_format_of(const Json& j) {
  FilmFormat f;
  FilmSettings& s = f.settings;
  s.width = integer_of(j.at("width"), kMostPixels), s.height = integer_of(j.at("height"), kMostPixels);
  s.crop = crop_of(j.at("crop")), s.half = j.at("half"), s.exposure = j.at("exposure");
  const Json& most = j.at("max_component");
  s.max_component = most.is_null() ? std::numeric_limits<double>::infinity() : most.get<double>();
  f.bands = integer_of(j.at("bands"), kMostBands);
  if (const Json nm = j.value("buckets_nm", Json()); !nm.is_null())
    s.buckets = int(f.bands), s.buckets_nm = {nm.at(0), nm.at(1)};
  f.channels = ChannelList(j.at("channels").get<std::vector<std::string>>()), f.halves = j.at("halves");
  const Json& exponent = j.at("exponent");
  if (!exponent.is_number_integer() || std::abs(exponent.get<double>()) > kMostExponent) reject(exponent, "exponent");
  f.exponent = exponent;
  f.color.row = j.at("color").get<std::array<Triple, 3>>(), f.white = j.at("white").get<Triple>();
  if (s.crop.x0 < 0 || s.crop.y0 < 0 || s.crop.x1 > s.width || s.crop.y1 > s.height || s.crop.width() <= 0 ||
      s.crop.height() <= 0)
    reject(j, "a film without pixels");
  f.splatting = splatting_of(j.at("splatting"), s.crop);
  return f;
}

Json json_of(const RenderStatistics& s) {
  return {{"paths", s.paths},
          {"rays", s.rays},
          {"wall_seconds", s.wall_seconds},
          {"cpu_seconds", s.cpu_seconds},
          {"escaped", s.ends.escaped},
          {"absorbed", s.ends.absorbed}};
}
RenderStatistics statistics_of(const Json& j) {
  RenderStatistics s;
  s.paths = integer_of<uint64_t>(j.at("paths")), s.rays = integer_of<uint64_t>(j.at("rays"));
  s.wall_seconds = j.at("wall_seconds"), s.cpu_seconds = j.at("cpu_seconds");
  for (size_t i = 0; i < s.ends.escaped.size(); ++i) {
    s.ends.escaped[i] = integer_of<uint64_t>(j.at("escaped").at(i));
    s.ends.absorbed[i] = integer_of<uint64_t>(j.at("absorbed").at(i));
  }
  return s;
}

std::string header_text(const PartHeader& h, const FilmFormat& film) {
  Json identity = Json::array();
  for (const Identity::Field& f : h.identity.fields()) identity.push_back({f.name, f.value});
  const Json j{{"identity", identity},
               {"film", json_of(film)},
               {"image",
                {{"space", h.image.space},
                 {"bands", json_of(h.image.bands)},
                 {"from_world", h.image.from_world},
                 {"attributes", h.image.attributes},
                 {"matrices", h.image.matrices},
                 {"materials", h.image.names.materials},
                 {"objects", h.image.names.objects}}},
               {"command", h.command},
               {"scene_crop", json_of(h.scene_crop)},
               {"pixel_scale", h.pixel_scale},
               {"request", h.request},
               {"adaptive", h.adaptive},
               {"tile_ends", h.tile_ends},
               {"round", h.round},
               {"statistics", json_of(h.statistics)}};
  return j.dump(1, ' ', false, Json::error_handler_t::replace);
}

PartHeader header_of(const Json& j) {
  PartHeader h;
  for (const Json& field : j.at("identity")) h.identity.add(field.at(0), field.at(1));
  const Json& image = j.at("image");
  h.image.space = image.at("space"), h.image.bands = bands_of(image.at("bands"));
  h.image.from_world = image.at("from_world").get<decltype(h.image.from_world)>();
  h.image.attributes = image.at("attributes").get<std::map<std::string, std::string>>();
  h.image.matrices = image.value("matrices", decltype(h.image.matrices)());
  h.image.names.materials = image.value("materials", decltype(h.image.names.materials)());
  h.image.names.objects = image.value("objects", decltype(h.image.names.objects)());
  h.command = j.at("command"), h.scene_crop = crop_of(j.at("scene_crop"));
  h.pixel_scale = integer_of(j.at("pixel_scale"), 2);
  h.request = integer_of<uint64_t>(j.at("request")), h.adaptive = j.at("adaptive");
  h.round = integer_of(j.at("round"), kMostRounds);
  for (const Json& end : j.at("tile_ends")) h.tile_ends.push_back(integer_of(end, kMostSamples));
  h.statistics = statistics_of(j.at("statistics"));
  return h;
}

PartHead parsed_head(const Json& j) { return {header_of(j), film_format_of(j.at("film"))}; }

// --- sums, compressed

class Compressor {
 public:
  explicit Compressor(std::vector<unsigned char>& to) : to_(to), context_(ZSTD_createCCtx()) {
    if (!context_) throw std::bad_alloc();
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, 1);
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
  }
  void add(const void* data, size_t bytes) { run({data, bytes, 0}, ZSTD_e_continue); }
  void finish() { run({nullptr, 0, 0}, ZSTD_e_end); }

 private:
  void run(ZSTD_inBuffer in, ZSTD_EndDirective end) {
    for (size_t left = 1; left != 0;) {
      const size_t start = to_.size();
      to_.resize(start + ZSTD_CStreamOutSize());
      ZSTD_outBuffer out{to_.data() + start, ZSTD_CStreamOutSize(), 0};
      left = ZSTD_compressStream2(context_.get(), &out, &in, end);
      if (ZSTD_isError(left)) fail({}, "a part cannot be compressed: {}", ZSTD_getErrorName(left));
      to_.resize(start + out.pos);
      if (end == ZSTD_e_continue) left = in.size - in.pos;
    }
  }

  struct Release {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  };
  std::vector<unsigned char>& to_;
  std::unique_ptr<ZSTD_CCtx, Release> context_;
};

class Decompressor {
 public:
  Decompressor(std::string_view from, const fs::path& path)
      : in_{from.data(), from.size(), 0}, path_(path), context_(ZSTD_createDCtx()) {
    if (!context_) throw std::bad_alloc();
  }
  void get(void* data, size_t bytes) {
    ZSTD_outBuffer out{data, bytes, 0};
    while (out.pos < out.size) step(out);
  }
  template <class T>
  T get() {
    T value;
    get(&value, sizeof value);
    return value;
  }
  /// Checks that all data were read. Decoding the last byte checks the checksum, so that no data may be used before.
  void finish() {
    char none;
    ZSTD_outBuffer out{&none, 0, 0};
    while (left_ != 0) step(out);
    if (in_.pos != in_.size) fail_to_read(path_, "is damaged");
  }

 private:
  void step(ZSTD_outBuffer& out) {
    const size_t in_before = in_.pos, out_before = out.pos;
    left_ = ZSTD_decompressStream(context_.get(), &out, &in_);
    if (ZSTD_isError(left_)) fail_to_read(path_, fmt::format("is damaged ({})", ZSTD_getErrorName(left_)));
    if (in_.pos == in_before && out.pos == out_before && left_ != 0) fail_to_read(path_, "is cut short");
    if (left_ == 0 && out.pos < out.size) fail_to_read(path_, "is damaged");
  }

  struct Release {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  ZSTD_inBuffer in_;
  const fs::path& path_;
  std::unique_ptr<ZSTD_DCtx, Release> context_;
  size_t left_ = 1;
};

void append(std::vector<unsigned char>& to, std::string_view bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }
void append(std::vector<unsigned char>& to, uint64_t number) {
  append(to, {reinterpret_cast<const char*>(&number), sizeof number});
}

void write_tile(const FilmTile& tile, Compressor& to) {
  const auto& items = tile.coverage().items();
  const uint64_t count = items.size();
  to.add(&count, sizeof count);
  for (const WorkItem& item : items) {
    static_assert(std::has_unique_object_representations_v<WorkItem>);
    to.add(&item, sizeof item);
  }
  PartFile::for_each_array(tile, [&to](const void* data, size_t bytes) { to.add(data, bytes); });
  for (const MatteList& list : PartFile::mattes(tile)) {
    static_assert(std::has_unique_object_representations_v<MatteList::Entry>);
    const uint64_t entries = list.entries().size();
    to.add(&entries, sizeof entries);
    to.add(list.entries().data(), entries * sizeof(MatteList::Entry));
  }
}

void read_tile(Decompressor& from, FilmTile& tile, const fs::path& path) {
  const auto count = from.get<uint64_t>();
  const Crop& pixels = tile.pixels();
  const auto is_within = [](int begin, int end, int least, int most) {
    return least <= begin && begin < end && end <= most;
  };
  for (uint64_t i = 0; i < count; ++i) {
    const auto item = from.get<WorkItem>();
    if (!is_within(item.pixels.x0, item.pixels.x1, pixels.x0, pixels.x1) ||
        !is_within(item.pixels.y0, item.pixels.y1, pixels.y0, pixels.y1) || item.samples.empty() ||
        item.samples.end > kMostSamples || !tile.cover(item))
      fail_to_read(path, "is damaged");
  }
  PartFile::for_each_array(tile, [&from](void* data, size_t bytes) { from.get(data, bytes); });
  if (!PartFile::has_counts_of_coverage(tile)) fail_to_read(path, "is damaged");
  for (MatteList& list : PartFile::mattes(tile)) {
    const auto entries = from.get<uint64_t>();
    for (uint64_t i = 0; i < entries; ++i) {
      const auto entry = from.get<MatteList::Entry>();
      if (!list.entries().empty() && entry.key <= list.entries().back().key) fail_to_read(path, "is damaged");
      list.add(entry.key, entry.weight);
    }
  }
}

uint64_t take_number(std::string_view& bytes) {
  uint64_t number = 0;
  std::memcpy(&number, bytes.data(), sizeof number);
  bytes.remove_prefix(sizeof number);
  return number;
}

/// Size of the header, which follows the magic number.
uint64_t take_header_size(std::string_view& bytes, const fs::path& path) {
  if (!bytes.starts_with(kMagic.substr(0, 11))) fail({}, "\"{}\" is not a part file", path.string());
  if (!bytes.starts_with(kMagic))
    fail({}, "\"{}\" is a part in another version of the format: this frond reads version 4", path.string());
  bytes.remove_prefix(kMagic.size());
  if (bytes.size() < sizeof(uint64_t)) fail_to_read(path, "is cut short");
  return take_number(bytes);
}

/// Parses the header and removes it from `bytes`.
Json take_header(std::string_view& bytes, const fs::path& path) {
  const uint64_t size = take_header_size(bytes, path);
  if (bytes.size() < sizeof(uint64_t) || size > bytes.size() - sizeof(uint64_t)) fail_to_read(path, "is cut short");
  const std::string_view text = bytes.substr(0, size);
  bytes.remove_prefix(size);
  if (take_number(bytes) != hash_bytes(text)) fail_to_read(path, "is damaged");
  return Json::parse(text);
}

/// Throws InputError for a header that claims a film far larger than the compressed sums can contain, before memory is
/// allocated. Zstandard compresses by 2^15 at most: blocks of 128 KiB in 4 bytes.
void check_claim(const FilmFormat& format, size_t compressed, const fs::path& path) {
  constexpr double kMostCompression = 1 << 15, kAlwaysAllowed = 1 << 20;
  const Crop& crop = format.settings.crop;
  const double least = double(crop.width()) * double(crop.height()) *
                       (sizeof(FilmTile::Pixel) + double(format.bands) * sizeof(FilmTile::BandSums));
  if (least > double(compressed) * kMostCompression + kAlwaysAllowed)
    fail_to_read(
        path, fmt::format("is damaged (its {} bytes claim {} x {} pixels)", compressed, crop.width(), crop.height()));
}

void check_readable(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || !std::ifstream(path)) read_file_bytes(path, {});  // throws with the reason
}

/// Reads the beginning of a part file up to the end of the header. Sets `rest_size` to the number of bytes that follow.
std::string read_front(const fs::path& path, size_t& rest_size) {
  std::ifstream file(path, std::ios::binary);
  std::string front(kMagic.size() + sizeof(uint64_t), '\0');
  file.read(front.data(), static_cast<std::streamsize>(front.size()));
  front.resize(static_cast<size_t>(file.gcount()));
  std::string_view rest = front;
  const uint64_t size = take_header_size(rest, path) + sizeof(uint64_t);
  std::error_code error;
  const uintmax_t whole = fs::file_size(path, error);
  const size_t start = front.size();
  if (error || size > whole || start + size > whole) fail_to_read(path, "is cut short");
  rest_size = whole - start - size;
  front.resize(start + size);
  file.read(front.data() + start, static_cast<std::streamsize>(size));
  front.resize(start + static_cast<size_t>(file.gcount()));
  return front;
}

}  // namespace

void write_part(const fs::path& path, const PartHeader& header, const Film& film) {
  replace_file(path, encode_part(header, film));
}

std::vector<unsigned char> encode_part(const PartHeader& header, const Film& film) {
  std::vector<unsigned char> bytes;
  const std::string text = header_text(header, film.format());
  append(bytes, kMagic);
  append(bytes, text.size());
  append(bytes, text);
  append(bytes, hash_bytes(text));
  Compressor compressor(bytes);
  for (size_t i = 0; i < film.tiles(); ++i) write_tile(film.snapshot(i), compressor);
  compressor.finish();
  append(bytes, kEnd);
  return bytes;
}

PartHead read_part_head(const fs::path& path) try {
  check_readable(path);
  size_t compressed = 0;
  const std::string front = read_front(path, compressed);
  std::string_view bytes = front;
  PartHead head = parsed_head(take_header(bytes, path));
  check_claim(head.film, compressed, path);
  return head;
} catch (const Json::exception& error) {
  fail_to_read(path, "is damaged");
}

RenderPart read_part(const fs::path& path) { return decode_part(read_file_bytes(path, {}), path); }

RenderPart decode_part(std::string_view bytes, const fs::path& path) try {
  if (bytes.starts_with(kMagic)) {
    if (!bytes.ends_with(kEnd)) fail_to_read(path, "is cut short");
    bytes.remove_suffix(kEnd.size());
  }
  PartHead head = parsed_head(take_header(bytes, path));
  check_claim(head.film, bytes.size(), path);
  Film film(head.film);
  RenderPart part{std::move(head.header), std::move(film)};
  Decompressor sums(bytes, path);
  if (const size_t ends = part.header.tile_ends.size(); ends > 0 && ends != part.film.tiles())
    fail_to_read(path, "is damaged");
  for (size_t i = 0; i < part.film.tiles(); ++i) {
    FilmTile tile(part.film.format(), part.film.tile_pixels(i));
    read_tile(sums, tile, path);
    part.film.merge(i, tile);
  }
  sums.finish();
  return part;
} catch (const Json::exception& error) {
  fail_to_read(path, "is damaged");
}

}  // namespace frond
