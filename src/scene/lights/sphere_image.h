#pragma once

#include "core/params.h"
#include "scene/lights/light_image.h"

namespace frond {

/// A light's image over all directions, by pbrt-v4's equal-area map of the sphere: a square one, or an error.
ColorImage read_sphere_image(const Params& p);

/// "scale", or what brings the image to "illuminance".
float sphere_image_scale(const Params& p, const ColorImage& file);

}  // namespace frond
