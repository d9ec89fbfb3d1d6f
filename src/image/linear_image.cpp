#include "image/linear_image.h"

#include "image/spectral_layout.h"

namespace frond {
namespace {

[[noreturn]] void refuse_without_colors(const std::string& path, const Image& image) {
  const auto bands = bands_of(image);
  if (bands.empty()) fail({}, "{} does not say in which colour space it is: images that frond has written do", path);
  fail({},
       "{} holds bands from {} to {} nm and no colours; frond convert --bands {},{},{} shows three of them, and frond "
       "compare --wavelengths bands,... tells errors band by band",
       path, bands.front(), bands.back(), bands.back(), bands[bands.size() / 2], bands.front());
}

}  // namespace

LinearImage read_linear(const std::string& path) {
  const ImageFile file = read_image(path, {});
  if (file.eight_bit) fail({}, "{} is encoded for a display: a linear image is needed, such as EXR", path);
  if (file.header.color_space.empty()) refuse_without_colors(path, file.image);
  LinearImage result{
      path, file.header.color_space, Image(file.image.width, file.image.height, {"R", "G", "B"}), {}, {}};
  if (const auto seed = file.header.text.find("frond:seed"); seed != file.header.text.end()) result.seed = seed->second;
  const auto leaf = file.image.channel("leaf");
  for (int y = 0; y < file.image.height; ++y)
    for (int x = 0; x < file.image.width; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const auto channel = file.image.channel(result.image.channels[c]);
        if (!channel) fail({}, "{} has no channel {}", path, result.image.channels[c]);
        result.image.at(x, y, c) = file.image.at(x, y, *channel);
      }
      if (leaf) result.leaf.push_back(file.image.at(x, y, *leaf));
    }
  return result;
}

void check_same_size(const LinearImage& a, const LinearImage& b) {
  if (a.image.width != b.image.width || a.image.height != b.image.height)
    fail({}, "{} is {} x {}, {} is {} x {}: images of one size are needed", a.path, a.image.width, a.image.height,
         b.path, b.image.width, b.image.height);
}

}  // namespace frond
