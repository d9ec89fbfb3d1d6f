#pragma once

#include "core/light.h"
#include "core/params.h"
#include "core/transform.h"

namespace frond {

/// Light from all around, an image's or the same from everywhere, that comes through a rectangle alone.
std::unique_ptr<Light> make_portal_light(const Params& p, const Transform& world_from_light);

}  // namespace frond
