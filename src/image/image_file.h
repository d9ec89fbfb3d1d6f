#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/image.h"
#include "spectra/color/color_space.h"

namespace frond {

/// The attribute that has a file's colour space.
inline constexpr const char* kColorSpaceKey = "frond:colorspace";

/// What an image file says beside its pixels.
struct ImageHeader {
  std::string color_space;                  ///< linear name of spectra/color/color_space.h; empty: unknown
  std::map<std::string, std::string> text;  ///< attributes by name, such as "frond:seed"
  /// Where the image lies in a larger one of which it is a part (EXR's data and display windows); 0: it is the whole.
  int x = 0, y = 0, full_width = 0, full_height = 0;
  /// Channels that stay floats in an EXR of halves: ids and places, which halves would round away.
  std::vector<std::string> full_precision = {};
};

enum class ExrDepth { half, single };

/// Refuses, by InputError, a path that `write_image` could not write: unknown extension, missing folder, no permission,
/// something that is no regular file. Nothing is left behind.
void check_writable(const std::filesystem::path& path);

/// Refuses, by InputError at `where`, an extension that `write_image` does not know.
void check_image_name(const std::filesystem::path& path, const Location& where);

/// By the extension, in whatever case.
bool is_exr(const std::filesystem::path& path);

/// Writes .exr (floats), or .png and .jpg (8 bits; values are already encoded for a display, and clamped to [0, 1]).
/// The image is encoded in memory, written beside its place, synchronised to the disk and renamed: a file of that name
/// is either the old one or the whole new one. Known colour spaces leave their chromaticities in an EXR. The date is
/// now, or SOURCE_DATE_EPOCH if that is set. Throws InputError when anything fails.
void write_image(const std::filesystem::path& path, const Image& image, const ImageHeader& header,
                 ExrDepth depth = ExrDepth::single);

struct ImageFile {
  Image image;
  ImageHeader header;
  std::optional<Chromaticities> chromaticities;
  bool eight_bit = false;   ///< values 0 to 255 in the file, here 0 to 1
  bool is_encoded = false;  ///< for a display, as 8 bits are and PNG is
};

/// Reads an image in any format that OpenImageIO knows (EXR, PNG, JPEG, HDR, TIFF, ...): values as they stand in the
/// file, alpha not multiplied in. Throws InputError at `where` if there is no such file or its data are not whole.
ImageFile read_image(const std::filesystem::path& path, const Location& where);

}  // namespace frond
