#include "openimageio/alpha.h"

#include <algorithm>
#include <cmath>

namespace frond {

bool is_multiplied(const EncodedImage& file, std::string_view format, int tga_alpha_type) {
  constexpr uint16_t kExtraSamples = 338;
  constexpr uint64_t kAssociatedAlpha = 1;  // TIFF 6.0
  constexpr int kPremultiplied = 4;         // TGA 2.0, field 24
  if (format == "tiff") return tiff_number(file.bytes, kExtraSamples) == kAssociatedAlpha;
  return format == "targa" && tga_alpha_type == kPremultiplied;
}

void divide_by_alpha(Image& image, size_t alpha, bool eight_bit) {
  constexpr float kWhite = 255;
  const size_t channels = image.channels.size();
  for (size_t i = 0; i < image.pixels.size(); i += channels) {
    const float a = image.pixels[i + alpha];
    if (!(a > 0)) continue;  // the colour is not in the file
    for (size_t c = 0; c < channels; ++c) {
      float& v = image.pixels[i + c];
      if (c != alpha) v = eight_bit ? std::round(std::min(v / a, 1.f) * kWhite) / kWhite : v / a;
    }
  }
}

}  // namespace frond
