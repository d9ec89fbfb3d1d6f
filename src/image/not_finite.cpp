#include "image/not_finite.h"

#include <fmt/format.h>

#include <cmath>

namespace frond {

std::string not_finite_text(const Image& image) {
  size_t nan = 0, infinite = 0, pixels = 0;
  const size_t channels = image.channels.size(), all = size_t(image.width) * size_t(image.height);
  for (size_t i = 0; i < all; ++i) {
    bool is_finite = true;
    for (size_t c = 0; c < channels; ++c) {
      const float v = image.pixels[i * channels + c];
      nan += std::isnan(v), infinite += std::isinf(v);
      is_finite = is_finite && std::isfinite(v);
    }
    pixels += !is_finite;
  }
  if (pixels == 0) return {};
  const std::string what = infinite == 0 ? fmt::format("{} NaN", nan)
                           : nan == 0    ? fmt::format("{} infinite", infinite)
                                         : fmt::format("{} NaN and {} infinite", nan, infinite);
  return fmt::format("{} value{} in {} of {} pixels", what, nan + infinite == 1 ? "" : "s", pixels, all);
}

}  // namespace frond
