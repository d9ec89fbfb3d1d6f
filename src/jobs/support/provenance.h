#pragma once

#include <fmt/format.h>

#include <vector>

#include "report/table.h"
#include "scene/scene.h"

namespace frond {

/// Returns the facts of a scene by which a measurement can be repeated: its seed, and the hash of its text as
/// frond:scene_hash of images.
inline std::vector<Fact> scene_provenance(const Scene& scene, const SceneSettings& description) {
  return {{"seed", std::to_string(scene.seed())}, {"scene_hash", fmt::format("{:016x}", description.content_hash)}};
}

}  // namespace frond
