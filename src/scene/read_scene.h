#pragma once

#include <filesystem>
#include <vector>

#include "core/log.h"
#include "core/problems.h"
#include "scene/format/description.h"
#include "scene/format/unsupported.h"
#include "scene/registry.h"

namespace frond {

/// Reads a scene as parse_scene does, and answers pbrt's plugins.
SceneDescription read_scene(const std::vector<std::filesystem::path>& paths, const Registry& registry, const Log& log,
                            const Unsupported& unsupported, Problems& problems);

/// As the next from text; `name` is what errors call it, and what it includes is found from there.
SceneDescription read_scene_text(const std::string& text, const std::string& name, const Registry& registry,
                                 const Log& log, const Unsupported& unsupported = {});

/// All errors at once as InputErrors.
SceneDescription read_scene(const std::filesystem::path& path, const Registry& registry, const Log& log,
                            const Unsupported& unsupported = {});

}  // namespace frond
