#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/build_record.h"
#include "image/image_file.h"

namespace frond {

/// Functions of OpenImageIO: decoding images and encoding 8-bit formats. Linking its 250 libraries at the start of
/// the program takes 0.3 s. They are therefore linked into a shared object (src/openimageio), which is loaded when an
/// image is first read, or first encoded as PNG or JPEG. Thread-safe.
class ImageCodec {
 public:
  virtual ~ImageCodec() = default;
  /// Decodes the bytes of an image file by the reader of this `format` (image_format_of) and no other. `path` names the
  /// file in messages. See read_image.
  virtual ImageFile decode(std::string_view bytes, std::string_view format, const std::filesystem::path& path,
                           const Location& where) const = 0;
  /// Returns the bytes of a .png or .jpg file (by the extension of `path`) with the attributes `text`. Values are
  /// clamped to [0, 1]. Throws InputError.
  virtual std::vector<unsigned char> encode(const std::filesystem::path& path, const Image& image,
                                            const std::map<std::string, std::string>& text) const = 0;
};

/// Returns the codec of image_codec_file(), which the first call loads. Throws as open_image_codec does.
const ImageCodec& image_codec();

/// Returns the path of the shared object: in the folder of the library's own file.
std::filesystem::path image_codec_file();

/// Loads the codec from a shared object. Throws InputError if it cannot be loaded or belongs to another build.
const ImageCodec& open_image_codec(const std::filesystem::path& file);

/// Record that the shared object's only function, `frond_image_codec`, returns.
struct ImageCodecModule {
  BuildRecord build = {};  ///< filled by its initialiser; do not set it
  const ImageCodec* codec = nullptr;
};

}  // namespace frond

extern "C" [[gnu::visibility("default")]] const frond::ImageCodecModule* frond_image_codec();
