#pragma once

#include <vector>

#include "image/image_file.h"

namespace frond {

/// The bytes of an OpenEXR file; `header` as write_image takes it, with the date among its text. Throws InputError.
std::vector<unsigned char> encode_exr(const Image& image, const ImageHeader& header, ExrDepth depth);

}  // namespace frond
