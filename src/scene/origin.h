#pragma once

#include <optional>
#include <vector>

#include "core/log.h"
#include "scene/format/description.h"
#include "scene/registry.h"

namespace frond {

/// Points of a scene file's spaces that become the origins of the rendered ones. Positions are kept in double precision
/// until these are subtracted, then rounded to 32 bits: rays lose no precision far from the origin of the file.
struct SceneOrigins {
  Vec3d world{};
  std::vector<Vec3d> objects{};  ///< by index in the description
  /// Whether any origin is not 0, or a shape has far points that its transform brings back: `moved_to` has something to
  /// do. Ordinary scenes keep their bits without it.
  bool move_something = false;
};

/// Returns the origins. The origin of a space is 0, unless nearly all positions in it are far from 0 (is_far): then it
/// is their median along each axis, rounded to whole units. Reads the beginning of meshes and instance tables. Warns of
/// shapes that are so far from the others that their coordinates are rounded to a visible part of their size.
SceneOrigins find_origins(const SceneDescription& description, const Log& log);

/// Returns the description in coordinates relative to the origins: transforms, points among the parameters, targets.
SceneDescription moved_to(const SceneOrigins& origins, SceneDescription description, const Registry& registry);
/// Finds the origins and moves the description; returns nullopt if there is nothing to move. `known`: origin of a scene
/// with the same geometry; nullptr: none. `world` is set to the world's origin, which is printed.
std::optional<SceneDescription> moved_to_origins(const SceneDescription& description, const Registry& registry,
                                                 const Log& log, const Vec3d* known, Vec3d& world);

}  // namespace frond
