#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/log.h"
#include "core/messages/problems.h"
#include "scene/format/description.h"

namespace frond {

/// Reads a scene file in pbrt-v4's format with all included files; "-" is standard input. After an error, the parser
/// continues at the next directive and throws all errors at the end (core/messages/problems.h), with file, line and
/// column. Files may be compressed (gzip).
SceneDescription parse_scene(const std::filesystem::path& path, const Log& log);

/// Reads a scene from one or several consecutive files, as pbrt does. Adds errors to `problems`, and returns what could
/// be read.
SceneDescription parse_scene(const std::vector<std::filesystem::path>& paths, const Log& log, Problems& problems);

/// Whether the file, or a file that it includes, contains WorldBegin, and thus completes a scene. Other errors are
/// ignored. An unreadable file counts as a scene; standard input does not, because it can be read only once.
bool contains_world(const std::filesystem::path& path);

/// Same as parse_scene for text; `name` is used in errors and to resolve Include.
SceneDescription parse_scene_text(const std::string& text, const std::string& name, const Log& log);

}  // namespace frond
