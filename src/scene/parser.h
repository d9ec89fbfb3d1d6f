#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/log.h"
#include "scene/description.h"

namespace frond {

/// Reads a scene file of pbrt-v4's format and everything that it includes; "-" is standard input. Throws InputError
/// with file, line and column for whatever is wrong, unknown, or of pbrt-v4 but not supported here.
SceneDescription parse_scene(const std::filesystem::path& path, const Log& log);

/// The same from text; `name` is what errors call it, and what Include resolves against.
SceneDescription parse_scene_text(const std::string& text, const std::string& name, const Log& log);

}  // namespace frond
