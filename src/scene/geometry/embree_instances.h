#pragma once

#include "scene/geometry/embree.h"
#include "scene/geometry/geometry_object.h"

namespace frond::embree {

/// Instances of objects for Embree, which they must outlive. Their queries are those of this folder: Query.
RTCGeometry new_geometry(RTCDevice device, const GeometryInstances& set);

}  // namespace frond::embree
