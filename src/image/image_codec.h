#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/build_record.h"
#include "image/image_file.h"

namespace frond {

/// What is left to OpenImageIO: reading all formats, writing those of 8 bits. To link its 250 libraries takes 0.3 s, so
/// it lies in a shared object of its own (src/openimageio), which is opened when an image is first read, or is to be
/// written as PNG or JPEG.
class ImageCodec {
 public:
  virtual ~ImageCodec() = default;
  /// As read_image.
  virtual ImageFile read(const std::filesystem::path& path, const Location& where) const = 0;
  /// The bytes of a .png or .jpg; values are clamped to [0, 1]. Throws InputError.
  virtual std::vector<unsigned char> encode(const std::filesystem::path& path, const Image& image,
                                            const std::map<std::string, std::string>& text) const = 0;
};

/// Opens image_codec_file() at the first call.
const ImageCodec& image_codec();

/// The shared object, beside the library's own file.
std::filesystem::path image_codec_file();

/// Throws InputError where the file cannot be loaded, or is of another build.
const ImageCodec& open_image_codec(const std::filesystem::path& file);

/// What the shared object offers: by its one function, `frond_image_codec`.
struct ImageCodecModule {
  BuildRecord build = {};  ///< leave it as it is
  const ImageCodec* codec = nullptr;
};

}  // namespace frond

extern "C" [[gnu::visibility("default")]] const frond::ImageCodecModule* frond_image_codec();
