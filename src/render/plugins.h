#pragma once

#include <span>
#include <string>

#include "scene/registry.h"

namespace frond {

/// All built-in plug-ins.
Registry builtin_registry();

/// The built-in plug-ins and those of the shared objects in the folders of FROND_PLUGIN_PATH and in `files`. Throws
/// InputError if a shared object cannot be loaded.
Registry load_registry(std::span<const std::string> files);

}  // namespace frond
