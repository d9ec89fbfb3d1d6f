#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "scene/registry.h"

namespace frond {

/// Loads a shared object (core/plugin_module.h) and adds its plug-ins to the registry. It is never unloaded, because
/// tables and objects point into it. Loading it twice adds it once. Throws InputError: no such file, not a shared
/// object, no frond_plugin, built for another frond, or a name that is taken.
void load_plugin(const std::filesystem::path& file, Registry& registry);

/// Returns the files *.so in folders separated by colons, by folder, then by name. Throws InputError for a missing
/// folder.
std::vector<std::filesystem::path> plugins_in(std::string_view folders);

}  // namespace frond
