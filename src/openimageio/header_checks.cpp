#include "openimageio/header_checks.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "core/messages/excerpt.h"
#include "system/utf8.h"

namespace frond {
namespace {

/// Returns the little-endian number at an offset, or 0 beyond the end.
template <class T>
T number_at(std::string_view bytes, size_t offset) {
  T value = 0;
  if (offset <= bytes.size() && bytes.size() - offset >= sizeof value)
    std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Takes a text that ends in a zero byte from the front; nothing if there is none.
std::optional<std::string_view> take_text(std::string_view& rest) {
  const size_t end = rest.find('\0');
  if (end == rest.npos) return {};
  const std::string_view text = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return text;
}

/// Values that the attributes of one part of an EXR state; 0 for a missing attribute.
struct ExrPart {
  int64_t width = 0, height = 0, channels = 0, tile_width = 0, tile_height = 0;
};

constexpr uint64_t kEachPixel = (uint64_t{1} << 32) | 1;  ///< sampling of an EXR's channel: 1 in x, 1 in y

/// Sizes of values by type. OpenEXR reads as many bytes, whatever size an attribute states: where it is another one,
/// the next attribute would begin elsewhere.
constexpr std::pair<std::string_view, size_t> kSizes[] = {{"box2f", 16},
                                                          {"box2i", 16},
                                                          {"chromaticities", 32},
                                                          {"compression", 1},
                                                          {"deepImageState", 1},
                                                          {"double", 8},
                                                          {"envmap", 1},
                                                          {"float", 4},
                                                          {"int", 4},
                                                          {"keycode", 28},
                                                          {"lineOrder", 1},
                                                          {"m33d", 72},
                                                          {"m33f", 36},
                                                          {"m44d", 128},
                                                          {"m44f", 64},
                                                          {"rational", 8},
                                                          {"tiledesc", 9},
                                                          {"timecode", 8},
                                                          {"v2d", 16},
                                                          {"v2f", 8},
                                                          {"v2i", 8},
                                                          {"v3d", 24},
                                                          {"v3f", 12},
                                                          {"v3i", 12}};

/// Returns the number of channels of a "chlist": names, each with 16 bytes of which the last eight are the sampling in
/// x and y, and an empty name at its end.
int64_t count_channels(std::string_view list, const EncodedImage& file) {
  constexpr size_t kAfterName = 16, kSampling = 8;
  int64_t channels = 0;
  auto channel = take_text(list);
  for (; channel && !channel->empty(); channel = take_text(list)) {
    if (!is_utf8(*channel)) file.reject("the name of a channel is not UTF-8");
    if (number_at<uint64_t>(list, kSampling) != kEachPixel)
      file.reject("channel \"{}\" has no value at each pixel: it is subsampled", excerpt(*channel, file.path));
    list.remove_prefix(std::min(kAfterName, list.size()));
    ++channels;
  }
  if (!channel || !list.empty()) file.reject("its list of channels has another size than it states");
  return channels;
}

/// Reads the attributes "channels", "compression", "dataWindow" and "tiles", and checks the sizes of all.
void read_attribute(std::string_view name, std::string_view type, std::string_view value, ExrPart& part,
                    const EncodedImage& file) {
  const auto* known = std::ranges::find(kSizes, type, [](const auto& size) { return size.first; });
  constexpr uint64_t kPreviewHeader = 8, kPreviewPixel = 4;
  const bool is_wrong = known != std::end(kSizes) ? value.size() != known->second
                        : type == "preview"
                            ? value.size() != kPreviewHeader + kPreviewPixel * number_at<uint32_t>(value, 0) *
                                                                   uint64_t(number_at<uint32_t>(value, 4))
                            : false;
  if (is_wrong) file.reject("an attribute of its header, of type {}, has {} bytes", type, value.size());
  const int64_t channels = type == "chlist" ? count_channels(value, file) : 0;
  if (name == "dataWindow") {  // four corners
    part.width = int64_t(number_at<int32_t>(value, 8)) - number_at<int32_t>(value, 0) + 1;
    part.height = int64_t(number_at<int32_t>(value, 12)) - number_at<int32_t>(value, 4) + 1;
  } else if (name == "compression") {
    constexpr int kLast = 9;  // DWAB
    const int compression = static_cast<unsigned char>(value.empty() ? '\0' : value[0]);
    if (compression > kLast) file.reject("EXR compression {} is not supported; save it as ZIP", compression);
  } else if (name == "tiles") {
    part.tile_width = number_at<uint32_t>(value, 0);
    part.tile_height = number_at<uint32_t>(value, 4);
  } else if (name == "channels") {
    part.channels = channels;
  }
}

/// OpenEXR allocates memory for whole tiles and rows, and offsets of all tiles, before it reads any.
void check_part(const ExrPart& part, const EncodedImage& file) {
  if (part.width == 0 || part.channels == 0) return;  // OpenEXR reports what is missing
  constexpr int64_t kMostRows = 256;                  // of a block (DWAB)
  check_claim(file, part.width, part.height, part.channels, kMostRows);
  if (part.tile_width == 0 || part.tile_height == 0) return;
  check_tiles(file, part.tile_width, part.tile_height, part.width, part.height);
  const auto count = [](int64_t size, int64_t tile) { return (size + tile - 1) / tile; };
  const int64_t tiles = count(part.width, part.tile_width) * count(part.height, part.tile_height);
  constexpr int64_t kOffset = 8;  // bytes of the table for each tile
  if (tiles > int64_t(file.bytes.size()) / kOffset)
    file.reject("its {} bytes claim {} tiles", file.bytes.size(), tiles);
}

/// OpenEXR File Layout: attributes of all parts.
void check_exr(const EncodedImage& file) {
  constexpr size_t kVersion = 4, kAttributes = 8;
  constexpr uint32_t kParts = 1 << 12;
  if (file.bytes.size() < kAttributes) return;
  const bool has_parts = (number_at<uint32_t>(file.bytes, kVersion) & kParts) != 0;
  std::string_view rest = file.bytes.substr(kAttributes);
  ExrPart part;
  for (;;) {
    const auto name = take_text(rest);
    if (!name) return;
    if (name->empty()) {  // the end of a part
      check_part(part, file);
      if (!has_parts || rest.empty() || rest.front() == '\0') return;
      part = {};
      continue;
    }
    const auto type = take_text(rest);
    if (!type || rest.size() < sizeof(int32_t)) return;
    const auto size = number_at<int32_t>(rest, 0);
    rest.remove_prefix(sizeof size);
    if (size < 0 || size_t(size) > rest.size())
      file.reject("an attribute of its header claims {} bytes, {} follow", size, rest.size());
    read_attribute(*name, *type, rest.substr(0, size_t(size)), part, file);
    rest.remove_prefix(size_t(size));
  }
}

/// OpenImageIO (2.4) looks colours up without regard to the size of the palette, and decodes compressed rows into any
/// kind of pixels.
void check_bmp(const EncodedImage& file) {
  constexpr size_t kPixels = 10, kHeader = 14, kOldHeader = 12;
  constexpr uint32_t kUncompressed = 0, kBitFields = 3;
  const auto header = number_at<uint32_t>(file.bytes, kHeader);
  const bool is_old = header == kOldHeader;  // of OS/2: no compression, a full palette
  const auto bits = number_at<uint16_t>(file.bytes, kHeader + (is_old ? 10 : 14));
  const auto compression = is_old ? kUncompressed : number_at<uint32_t>(file.bytes, kHeader + 16);
  const auto colors = is_old ? 0 : number_at<uint32_t>(file.bytes, kHeader + 32);
  if (compression != kUncompressed && !(compression == kBitFields && (bits == 16 || bits == 32)))
    file.reject("compressed BMP is not supported; save it as PNG");
  if (bits > 8 || colors == 0 || colors == 1u << bits) return;
  const auto pixels = std::min<size_t>(number_at<uint32_t>(file.bytes, kPixels), file.bytes.size());
  const auto is_known = [colors](char index) { return static_cast<unsigned char>(index) < colors; };
  if (bits != 8 || !std::ranges::all_of(file.bytes.substr(pixels), is_known))
    file.reject("its palette has {} of {} colours; save it as PNG", colors, 1u << bits);
}

/// Where the tag BitsPerSample is missing, OpenImageIO (2.4) takes 8 bits and libtiff 1, so that most of the pixels
/// would be uninitialised memory.
void check_tiff(const EncodedImage& file) {
  constexpr uint16_t kBitsPerSample = 258;
  if (!tiff_number(file.bytes, kBitsPerSample)) file.reject("its header has no BitsPerSample");
}

/// OpenImageIO (2.4) looks colours up without regard to the size of the palette.
void check_tga(const EncodedImage& file) {
  constexpr size_t kType = 2;
  constexpr uint8_t kIndices = 1, kCompressedIndices = 9;
  const auto type = number_at<uint8_t>(file.bytes, kType);
  if (type == kIndices || type == kCompressedIndices)
    file.reject("TGA with a palette is not supported; save it as PNG");
}

}  // namespace

/// TIFF 6.0 and BigTIFF: an entry is a tag, a type, the number of its values, and these or where they are.
std::optional<uint64_t> tiff_number(std::string_view bytes, uint16_t tag) {
  const bool is_little = bytes.starts_with('I');
  const auto number = [&](uint64_t offset, uint64_t size) {  // 0 beyond the end
    uint64_t value = 0;
    if (offset > bytes.size() || bytes.size() - offset < size) return value;
    for (uint64_t i = 0; i < size; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes[offset + (is_little ? size - 1 - i : i)]);
    return value;
  };
  constexpr uint64_t kBig = 43, kShort = 3;
  const bool is_big = number(2, 2) == kBig;
  const uint64_t count_size = is_big ? 8 : 2, entry_size = is_big ? 20 : 12, value = is_big ? 12 : 8;
  const uint64_t directory = is_big ? number(8, 8) : number(4, 4);
  const uint64_t entries = std::min(number(directory, count_size), bytes.size() / entry_size);
  for (uint64_t i = 0; i < entries; ++i) {
    const uint64_t entry = directory + count_size + i * entry_size;
    if (number(entry, 2) == tag) return number(entry + value, number(entry + 2, 2) == kShort ? 2 : 4);
  }
  return {};
}

void check_claim(const EncodedImage& file, int64_t width, int64_t height, int64_t channels, int64_t rows) {
  constexpr int64_t kMostCompression = 16384;  // images of 8 bits compress by 1032 at most (deflate)
  constexpr int64_t kAlwaysAllowed = 256 << 20, kMostChannels = 1 << 12, kMostSide = int64_t{1} << 31;
  const int64_t most = int64_t(file.bytes.size()) * kMostCompression + kAlwaysAllowed;
  const bool has_pixels = width > 0 && height > 0 && channels > 0;
  if (has_pixels && channels <= kMostChannels && width <= kMostSide && height <= kMostSide &&
      width * std::max(height, rows) <= most / (channels * int64_t(sizeof(float))))
    return;
  fail(file.where, "image \"{}\" of {} bytes claims {} x {} pixels of {} channels{}", file.path.string(),
       file.bytes.size(), width, height, channels,
       channels > kMostChannels ? fmt::format(": {} channels are the limit", kMostChannels) : "");
}

void check_tiles(const EncodedImage& file, int64_t tile_width, int64_t tile_height, int64_t width, int64_t height) {
  constexpr int64_t kLargest = 1024;  // where the image is smaller
  if (tile_width > std::max(width, kLargest) || tile_height > std::max(height, kLargest))
    file.reject("its tiles of {} x {} pixels are larger than its {} x {} pixels", tile_width, tile_height, width,
                height);
}

void check_header(const EncodedImage& file, std::string_view format) {
  if (format == "openexr") check_exr(file);
  if (format == "bmp") check_bmp(file);
  if (format == "targa") check_tga(file);
  if (format == "tiff") check_tiff(file);
}

}  // namespace frond
