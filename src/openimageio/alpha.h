#pragma once

#include "core/image.h"
#include "openimageio/header_checks.h"

namespace frond {

/// Whether a TIFF or TGA with alpha states that its colours are multiplied by it, and OpenImageIO leaves them so.
/// Colours of an EXR are multiplied by definition, and remain so, as in pbrt-v4. `tga_alpha_type`: OpenImageIO's
/// "targa:alpha_type".
bool is_multiplied(const EncodedImage& file, std::string_view format, int tga_alpha_type);

/// Divides the colours by the alpha; where it is 0, they are unknown and remain unchanged. `eight_bit`: values are
/// rounded to 1/255.
void divide_by_alpha(Image& image, size_t alpha, bool eight_bit);

}  // namespace frond
