#include "image/rgb_image.h"

#include <cmath>

#include "image/image_file.h"

namespace frond {

RgbImage read_rgb(const std::filesystem::path& path, const Location& where) {
  const auto [image, header, chromaticities, eight_bit] = read_image(path, where);
  std::array<size_t, 3> channels{};
  if (image.channels.size() > 2) {
    constexpr std::array<std::string_view, 3> names{"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
      const auto channel = image.channel(names[c]);
      if (!channel) fail(where, "{} has no channel {}", path.string(), names[c]);
      channels[c] = *channel;
    }
  }
  RgbImage result{image.width, image.height, {}, eight_bit};
  result.rgb.reserve(size_t(image.width) * size_t(image.height) * 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const size_t c : channels) {
        const float v = image.at(x, y, c);
        if (!std::isfinite(v)) fail(where, "{} holds the value {} in column {}, row {}", path.string(), v, x, y);
        result.rgb.push_back(v);
      }
  return result;
}

void decode_srgb(RgbImage& image) {
  for (float& v : image.rgb) v = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace frond
