#pragma once

#include <filesystem>
#include <vector>

#include "core/log.h"
#include "core/messages/problems.h"
#include "scene/format/description.h"
#include "scene/format/unsupported.h"
#include "scene/registry.h"

namespace frond {

/// Reads a scene as parse_scene does, and replaces pbrt's plug-ins.
SceneDescription read_scene(const std::vector<std::filesystem::path>& paths, const Registry& registry, const Log& log,
                            const Unsupported& unsupported, Problems& problems);

/// Same for text; `name` is used in errors and to resolve included files.
SceneDescription read_scene_text(const std::string& text, const std::string& name, const Registry& registry,
                                 const Log& log, const Unsupported& unsupported = {});

/// Throws all errors together as InputErrors.
SceneDescription read_scene(const std::filesystem::path& path, const Registry& registry, const Log& log,
                            const Unsupported& unsupported = {});

}  // namespace frond
