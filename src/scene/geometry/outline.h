#pragma once

#include "scene/geometry/geometry.h"

namespace frond {

/// Returns points whose convex hull contains the object. A tighter hull makes rays enter fewer instances.
std::vector<Vec3> outline_of(const ObjectParts& parts, const Bounds& bounds);

}  // namespace frond
