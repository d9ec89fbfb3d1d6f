#pragma once

#include "core/log.h"
#include "core/params.h"
#include "image/image_file.h"

namespace frond {

/// Reads an image file as an image with the channels R, G and B, for textures and lights. The first channel of a file
/// with one or two channels (grey, grey and alpha) is repeated. Throws InputError at `where` if the file cannot be
/// read, lacks one of the channels or contains values that are not finite.
ImageFile read_rgb(const std::filesystem::path& path, const Location& where);

/// Reads the image of a parameter that names a file, and warns of other content of the file: further parts, and
/// channels other than R, G, B, A and Y. Throws as the functions without a parameter do.
ImageFile read_rgb(const Params& p, std::string_view name);
ImageFile read_finite(const Params& p, std::string_view name);

/// Returns the colour space of a file, by the name in its header or by its chromaticities; sRGB if the file states
/// neither, nullptr if its chromaticities are not those of a known space.
const ColorSpace* color_space_of(const ImageFile& file);

/// Reads an image file with all its channels, as read_image. Throws InputError at `where` also if a value is not
/// finite.
ImageFile read_finite(const std::filesystem::path& path, const Location& where);

/// Returns the linear value of an sRGB-encoded one (IEC 61966-2-1).
float decode_srgb(float v);
/// Decodes all channels of an image in place.
void decode_srgb(Image& image);

/// Content of a linear image file. Files of renders also state a seed and can have a leaf channel.
struct LinearFile {
  std::string path, space;                 ///< file name, and linear name of the colour space
  bool is_assumed = false;                 ///< the file does not state the space
  Image image;                             ///< R G B
  std::vector<float> leaf;                 ///< foliar ratio of each pixel; empty: not in the file
  std::string seed;                        ///< seed of the render, from the header; empty: not in the file
  std::vector<std::string> left_out = {};  ///< as in ImageFile
  double correlated_pixels = 1;  ///< upper bound of the variance of a sum of pixels over that of independent pixels
};

/// Reads a linear image file. Its colour space is the one that its header names, or that has its chromaticities;
/// `otherwise` if it states neither. Throws InputError if the file is encoded for a display, lacks R, G or B, states
/// chromaticities of no known space, or states nothing and `otherwise` is empty.
LinearFile read_linear(const std::string& path, const std::string& otherwise = {});

/// Throws InputError, which names both files, if the images differ in width or height.
void check_same_size(const LinearFile& a, const LinearFile& b);

}  // namespace frond
