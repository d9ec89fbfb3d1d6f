// Images: the first byte of the input decides the extension.

#include "image/image_file.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(image, bytes) {
  constexpr std::array kExtensions{"exr", "png", "jpg", "hdr", "tif", "pfm", "tga", "bmp", "gif", "avi", "null", "iff"};
  if (bytes.empty()) return;
  const std::string name = std::string("image.") + kExtensions[uint8_t(bytes[0]) % kExtensions.size()];
  bytes.remove_prefix(1);
  const auto path = fuzz::folder().write(name, bytes);
  fuzz::accepts([&] {
    const Image image = read_image(path, {}).image;
    fuzz::require(image.width > 0 && image.height > 0 && !image.channels.empty(), "an image has pixels");
    fuzz::require(image.pixels.size() == size_t(image.width) * size_t(image.height) * image.channels.size(),
                  "each pixel has its channels");
  });
  std::filesystem::remove(path);
}
