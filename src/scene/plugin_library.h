#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "scene/registry.h"

namespace frond {

/// Loads a shared object (core/plugin_module.h) and adds what it offers to the tables. It stays loaded for good: tables
/// and objects point into it. Loading one twice adds it once. Throws InputError: no such file, no shared
/// object, no frond_plugin, built for another frond, or a name that is taken.
void load_plugin(const std::filesystem::path& file, Registry& registry);

/// The files *.so of folders that are separated by colons, in the order of the folders, by name in each. Throws
/// InputError where there is no such folder.
std::vector<std::filesystem::path> plugins_in(std::string_view folders);

}  // namespace frond
