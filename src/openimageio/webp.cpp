#include "openimageio/webp.h"

#include <webp/decode.h>

#include <algorithm>

namespace frond {

ImageFile decode_webp(const EncodedImage& file) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(file.bytes.data());
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes, file.bytes.size(), &features) != VP8_STATUS_OK) file.reject("its header is damaged");
  // The simple decoder would take such a file for a damaged one.
  if (features.has_animation) file.reject("it is an animation; save one of its frames");
  const bool has_alpha = features.has_alpha != 0;
  std::vector<std::string> channels{"R", "G", "B"};
  if (has_alpha) channels.emplace_back("A");
  check_claim(file, features.width, features.height, int64_t(channels.size()));
  ImageFile result{.image = Image(features.width, features.height, channels),
                   .header = {},
                   .chromaticities = {},
                   .eight_bit = true,
                   .is_encoded = true};
  std::vector<float>& to = result.image.pixels;
  std::vector<uint8_t> values(to.size());
  const int row_bytes = features.width * int(channels.size());
  // These leave the colours as they are stored; those with premultiplied alpha have other names.
  const auto decode = has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (!decode(bytes, file.bytes.size(), values.data(), values.size(), row_bytes))
    file.reject("its data are damaged or incomplete");
  constexpr float kWhite = 255;
  std::ranges::transform(values, to.begin(), [](uint8_t v) { return float(v) / kWhite; });
  return result;
}

}  // namespace frond
