#pragma once

#include <filesystem>
#include <vector>

#include "core/log.h"
#include "core/problems.h"
#include "scene/description.h"
#include "scene/registry.h"
#include "scene/unsupported.h"

namespace frond {

/// Names of pbrt-v4 that frond answers by plugins of another name. What gives the same picture, but for noise, is told
/// in the log (samplers; volpath, where there are no media); what does not has to be let pass (scene/unsupported.h).
/// Names of older versions of pbrt are errors that say how a file is upgraded.
void answer_pbrt_plugins(SceneDescription& description, const Registry& registry, const Unsupported& unsupported,
                         const Log& log, Problems& problems);

/// Reads a scene as parse_scene does, and answers pbrt's plugins.
SceneDescription read_scene(const std::vector<std::filesystem::path>& paths, const Registry& registry, const Log& log,
                            const Unsupported& unsupported, Problems& problems);

/// All errors at once as InputErrors.
SceneDescription read_scene(const std::filesystem::path& path, const Registry& registry, const Log& log,
                            const Unsupported& unsupported = {});

}  // namespace frond
