#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/log.h"
#include "core/problems.h"
#include "scene/format/description.h"
#include "scene/format/unsupported.h"

namespace frond {

/// Reads a scene file of pbrt-v4's format and everything that it includes; "-" is standard input. Goes on after an
/// error at the next directive: all of them are thrown at the end (core/problems.h), with file, line and column, for
/// whatever is wrong, unknown, or of pbrt-v4 but not supported here. Files may be compressed (gzip).
SceneDescription parse_scene(const std::filesystem::path& path, const Log& log, const Unsupported& unsupported = {});

/// A scene in one file or in several that are read one after the other, as pbrt does. Errors go to `problems`, and what
/// could be read is returned.
SceneDescription parse_scene(const std::vector<std::filesystem::path>& paths, const Log& log,
                             const Unsupported& unsupported, Problems& problems);

/// Whether this file or one that it includes holds WorldBegin: then it is a scene, else a piece of one. Whatever else
/// is wrong there; one that cannot be read is a scene of its own, but standard input, which can be read once, is a
/// piece.
bool holds_world(const std::filesystem::path& path);

/// As the first from text; `name` is what errors call it, and what Include resolves against.
SceneDescription parse_scene_text(const std::string& text, const std::string& name, const Log& log,
                                  const Unsupported& unsupported = {});

}  // namespace frond
