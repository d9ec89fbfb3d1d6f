#include "image/image_codec.h"

/// The library for image files of another frond. `core/math/vec.h` is another one there.
namespace {
[[gnu::used, gnu::section("frond_headers")]] const char kOther[] = "core/math/vec.h 0123456789abcdef";
}

const frond::ImageCodecModule* frond_image_codec() {
  static const frond::ImageCodecModule module;
  return &module;
}
