#pragma once

#include "core/light.h"
#include "core/math/transform.h"
#include "core/params.h"

namespace frond {

/// Returns an infinite light (an image or uniform) that enters only through a rectangle.
std::unique_ptr<Light> make_portal_light(const Params& p, const Transform& world_from_light);

}  // namespace frond
