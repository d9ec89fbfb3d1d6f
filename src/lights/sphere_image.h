#pragma once

#include "core/params.h"
#include "lights/light_image.h"

namespace frond {

/// Reads a light's image over all directions in pbrt-v4's equal-area parameterization. Throws InputError unless it is
/// square.
ColorImage read_sphere_image(const Params& p);

/// Returns "scale", or the factor that gives the image the stated "illuminance".
float sphere_image_scale(const Params& p, const ColorImage& file);

}  // namespace frond
