#pragma once

#include "core/log.h"
#include "scene/format/description.h"
#include "scene/geometry/geometry.h"

namespace frond {

/// Throws InputError where a Texture "instance" asks for a column that no table of copies has; warns where the column
/// goes beyond the texture's range.
void check_instance_textures(const SceneSettings& description, const Geometry& geometry, const Log& log);

}  // namespace frond
