#include "image/image_codec.h"

#include <string_view>

#include "system/build_check.h"
#include "system/shared_object.h"

namespace frond {
std::filesystem::path image_codec_file() { return own_file().parent_path() / FROND_IMAGE_CODEC_FILE; }

const ImageCodec& open_image_codec(const std::filesystem::path& file) {
  constexpr std::string_view kWhat = "frond's library for image files";
  const SharedObject library(file, kWhat, SharedObject::Binding::lazy);
  const auto function = library.find<decltype(frond_image_codec)>("frond_image_codec");
  if (!function) fail({}, "{} \"{}\" has no function frond_image_codec", kWhat, file.string());
  const ImageCodecModule* module = function();
  if (const std::string problem = build_mismatch(module->build); !problem.empty())
    fail({}, "{} \"{}\" {}", kWhat, file.string(), problem);
  return *module->codec;
}

const ImageCodec& image_codec() {
  static const ImageCodec& codec = open_image_codec(image_codec_file());
  return codec;
}

}  // namespace frond
