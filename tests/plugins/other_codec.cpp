// Compiled with tests/plugins/other_build in front: the library for image files of another frond.
#include "image/image_codec.h"

const frond::ImageCodecModule* frond_image_codec() {
  static const frond::ImageCodecModule module;
  return &module;
}
