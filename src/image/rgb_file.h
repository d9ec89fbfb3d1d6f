#pragma once

#include "image/image_file.h"

namespace frond {

/// An image file with R, G and B in place of its channels, or with its only colour three times; for textures and
/// lights. Throws InputError at `where`, for values that are not finite too.
ImageFile read_rgb(const std::filesystem::path& path, const Location& where);

/// By the name in its header or its chromaticities; sRGB where the file says nothing, nullptr for a space of its own
/// that is not known.
const ColorSpace* color_space_of(const ImageFile& file);

/// An image file with all of its channels, as read_image, whose values are finite. Throws InputError at `where`.
ImageFile read_finite(const std::filesystem::path& path, const Location& where);

/// To a linear value, by the curve of IEC 61966-2-1.
float decode_srgb(float v);
void decode_srgb(Image& image);

/// What a linear image file says: of a render, if it has a leaf channel and a seed.
struct LinearFile {
  std::string path, space;
  Image image;                   ///< R G B
  std::vector<float> leaf;       ///< share of leaf of each pixel; empty: not in the file
  std::string seed;              ///< of the render, as its header says; empty: it does not
  double correlated_pixels = 1;  ///< that share the noise of one, as the header says
};

/// Throws InputError when the file is not linear or lacks a channel.
LinearFile read_linear(const std::string& path);

void check_same_size(const LinearFile& a, const LinearFile& b);

}  // namespace frond
