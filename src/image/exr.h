#pragma once

#include <span>
#include <vector>

#include "image/image_file.h"

namespace frond {

/// The bytes of an OpenEXR file; `header` as write_image takes it, with the date among its text. Throws InputError.
std::vector<unsigned char> encode_exr(const Image& image, const ImageHeader& header, ExrDepth depth);

/// To values that ExrDepth::half keeps.
void round_to_halves(std::span<float> values);

}  // namespace frond
