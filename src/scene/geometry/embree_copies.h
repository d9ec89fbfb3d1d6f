#pragma once

#include "scene/geometry/embree.h"
#include "scene/geometry/geometry_object.h"

namespace frond::embree {

/// Copies of objects for Embree, which they must outlive. Their queries are those of this folder: Query.
RTCGeometry new_geometry(RTCDevice device, const GeometryCopies& copies);

}  // namespace frond::embree
