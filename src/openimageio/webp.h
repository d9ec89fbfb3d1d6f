#pragma once

#include "image/image_file.h"
#include "openimageio/header_checks.h"

namespace frond {

/// Decodes a WebP by libwebp: OpenImageIO's reader multiplies the colours by alpha, in 8 bits, so that the file's
/// colours are lost. Throws InputError, also for an animation.
ImageFile decode_webp(const EncodedImage& file);

}  // namespace frond
