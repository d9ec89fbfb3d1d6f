#pragma once

#include "core/log.h"
#include "core/parallel.h"
#include "core/problems.h"
#include "scene/geometry/geometry.h"
#include "scene/resolver.h"

namespace frond {

/// The description's shapes and the instances of its objects. Goes on after a shape with an error; throws all that
/// `problems` then has.
std::shared_ptr<const Geometry> build_geometry(const SceneDescription& description, const Registry& registry,
                                               SceneResolver& resolver, const ThreadPool& pool, const Log& log,
                                               Problems& problems);

/// Throws InputError where a Texture "instance" asks for a column that no table of instances has; warns where the
/// column goes beyond the texture's range.
void check_instance_textures(const SceneSettings& description, const Geometry& geometry, const Log& log);

}  // namespace frond
