#pragma once

#include "scene/geometry/embree.h"
#include "scene/geometry/geometry_object.h"

namespace frond::embree {

/// Returns an Embree geometry of instances. `set` must outlive it. Queries must use the context Query.
RTCGeometry new_geometry(RTCDevice device, const GeometryInstances& set);

}  // namespace frond::embree
