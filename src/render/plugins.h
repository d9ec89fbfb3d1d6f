#pragma once

#include <span>
#include <string>

#include "scene/registry.h"

namespace frond {

/// Every plugin that this build knows.
Registry builtin_registry();

/// Every plugin that a scene can name: those of this build, of the shared objects in the folders of FROND_PLUGIN_PATH,
/// and of `files`. Throws InputError.
Registry load_registry(std::span<const std::string> files);

}  // namespace frond
