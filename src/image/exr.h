#pragma once

#include <span>
#include <vector>

#include "image/image_file.h"

namespace frond {

/// Returns the bytes of an OpenEXR file (ZIP compression). `header` is as for write_image, with the date in its text.
/// Throws InputError.
std::vector<unsigned char> encode_exr(const Image& image, const ImageHeader& header, ExrDepth depth);

/// Rounds values to the nearest that a file of ExrDepth::half stores.
void round_to_halves(std::span<float> values);

}  // namespace frond
