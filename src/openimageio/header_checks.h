#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace frond {

/// An image file in memory, and the location in the scene that refers to it.
struct EncodedImage {
  std::string_view bytes;
  const std::filesystem::path& path;
  const Location& where;

  /// Throws InputError: "cannot read image ...: " and the message.
  template <class... Args>
  [[noreturn]] void reject(fmt::format_string<Args...> format, Args&&... args) const {
    fail(where, "cannot read image \"{}\": {}", path.string(), fmt::format(format, std::forward<Args>(args)...));
  }
};

/// Throws InputError if an image of this size has no pixels, more bytes of floats than 256 MB and 16,384 times the
/// file's size, or more than 4,096 channels. `rows`: at once, for which memory is allocated even where there are fewer;
/// OpenImageIO's 64.
void check_claim(const EncodedImage& file, int64_t width, int64_t height, int64_t channels, int64_t rows = 64);

/// Throws InputError if tiles are larger than the image and than 1024 x 1024 pixels: their memory is allocated before
/// they are read.
void check_tiles(const EncodedImage& file, int64_t tile_width, int64_t tile_height, int64_t width, int64_t height);

/// Throws InputError for headers that OpenImageIO's readers or OpenEXR follow beyond the file's data. `format` is one
/// of image_format_of. Damage that they report themselves is left to them.
void check_header(const EncodedImage& file, std::string_view format);

/// Returns the first value of an entry of a TIFF's first directory, if the entry itself contains it; nullopt if there
/// is no such entry.
std::optional<uint64_t> tiff_number(std::string_view bytes, uint16_t tag);

}  // namespace frond
