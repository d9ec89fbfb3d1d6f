#pragma once

#include <filesystem>
#include <vector>

#include "core/error.h"

namespace frond {

/// Three channels of an image file, for textures and lights.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<float> rgb;     ///< three for each pixel, rows from the top, as they stand in the file
  bool is_eight_bit = false;  ///< still encoded for a display
};

/// To linear values, by the curve of IEC 61966-2-1.
void decode_srgb(RgbImage& image);

/// R, G and B of an image, or its only channel three times. Throws InputError at `where`.
RgbImage read_rgb(const std::filesystem::path& path, const Location& where);

}  // namespace frond
