#pragma once

#include "scene/geometry/geometry.h"

namespace frond {

/// Points around an object, within whose hull it lies: the tighter they are, the fewer of its instances a ray has to
/// look into.
std::vector<Vec3> outline_of(const ObjectParts& parts, const Bounds& bounds);

}  // namespace frond
