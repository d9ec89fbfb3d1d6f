#pragma once

#include "core/log.h"
#include "core/messages/problems.h"
#include "core/parallel.h"
#include "scene/geometry/geometry.h"
#include "scene/resolver.h"

namespace frond {

/// Limit of the coordinates of shapes, lights and cameras. Embree takes rays and geometry up to 1.8e18, and the ray
/// from one point to another is as long as their distance.
inline constexpr float kFarthest = 5e17f;

/// Throws InputError, `what` and the point, for a coordinate beyond kFarthest or NaN.
void check_coordinates(const Vec3& p, std::string_view what, const Location& where);

/// Builds the geometry of the description's shapes and instances. `shutter`: as Scene::shutter. Continues after an
/// invalid shape; throws all errors in `problems` at the end.
std::shared_ptr<const Geometry> build_geometry(const SceneDescription& description, const Registry& registry,
                                               SceneResolver& resolver, Interval shutter, const ThreadPool& pool,
                                               const Log& log, Problems& problems);

/// Throws InputError for a Texture "instance" whose column is in no instance table. Warns if the column exceeds the
/// texture's range.
void check_instance_textures(const SceneSettings& description, const Geometry& geometry, const Log& log);

}  // namespace frond
