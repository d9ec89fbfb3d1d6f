#pragma once

#include <array>
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

/// Header attribute with a file's colour space.
inline constexpr const char* kColorSpaceKey = "frond:colorspace";

/// Matrix of an EXR's header, row by row.
using HeaderMatrix = std::array<float, 16>;

/// Metadata of an image file.
struct ImageHeader {
  std::string color_space;                  ///< linear name of spectra/color/color_space.h; empty: unknown
  std::map<std::string, std::string> text;  ///< attributes by name, such as "frond:seed"
  /// Position of a crop in the full image and the size of that image, pixels (EXR's data and display windows); 0: the
  /// image is not a crop.
  int x = 0, y = 0, full_width = 0, full_height = 0;
  /// Channels that are stored as floats in an EXR of halves: ids and positions, which halves cannot represent.
  std::vector<std::string> full_precision = {};
  std::map<std::string, HeaderMatrix> matrices = {};  ///< matrices by name, in an EXR alone, when it is written
  int samples = 0;                                    ///< samples of each pixel, the same way; 0: unknown
};

/// Floating-point format of an EXR's channels: 16 or 32 bits.
enum class ExrDepth { half, single };

/// Throws InputError for a path that `write_image` could not write: unknown extension, missing folder, no permission,
/// not a regular file. No file remains after the check.
void check_writable(const std::filesystem::path& path);

/// Throws InputError at `where` for an extension that `write_image` does not support.
void check_image_name(const std::filesystem::path& path, const Location& where);

/// Returns whether the extension, in upper or lower case, is .exr. Throws as check_image_name does.
bool is_exr(const std::filesystem::path& path);

/// Writes .exr (floats or halves), or .png and .jpg (8 bits; values are already encoded for a display, and are clamped
/// to [0, 1]). The file is written atomically (replace_file): a file of this name is either the old one or the complete
/// new one. An EXR in a known colour space stores its chromaticities. The date is file_time(). Throws InputError on any
/// failure.
void write_image(const std::filesystem::path& path, const Image& image, const ImageHeader& header,
                 ExrDepth depth = ExrDepth::single);

/// Returns the content of the file that `write_image` would write.
std::vector<unsigned char> image_bytes(const std::filesystem::path& path, const Image& image, const ImageHeader& header,
                                       ExrDepth depth = ExrDepth::single);

/// Image file as read.
struct ImageFile {
  Image image;
  ImageHeader header;
  std::optional<Chromaticities> chromaticities;  ///< from an EXR's header
  bool eight_bit = false;                        ///< the file stores 0 to 255, which is here 0 to 1
  bool is_encoded = false;                       ///< values are encoded for a display: 8-bit formats and PNG
  std::vector<std::string> left_out = {};        ///< messages about what else the file holds: warn of it
};

/// Reads an image file: EXR, PNG, JPEG, HDR, TIFF, PFM, BMP, WebP or TGA (image/image_signature.h). Values are the
/// file's, without conversion of colours; colours that a TIFF or TGA states to be multiplied by alpha are divided by
/// it. Of several parts (EXR) or pages (TIFF) the first is read. Throws InputError at `where` if the file does not
/// exist, has another format, is damaged or incomplete.
ImageFile read_image(const std::filesystem::path& path, const Location& where);

}  // namespace frond
