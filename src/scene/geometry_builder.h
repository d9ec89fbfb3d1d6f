#pragma once

#include "core/log.h"
#include "core/parallel.h"
#include "scene/geometry.h"
#include "scene/resolver.h"

namespace frond {

/// The description's shapes and the copies of its objects. Throws InputError.
std::shared_ptr<const Geometry> build_geometry(const SceneDescription& description, const Registry& registry,
                                               SceneResolver& resolver, const ThreadPool& pool, const Log& log);

}  // namespace frond
