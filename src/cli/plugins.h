#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/registry.h"

namespace CLI {
class App;
}

namespace frond {

/// `--plugin FILE`, which may be given again.
void add_plugin_option(CLI::App& command, std::vector<std::string>& files);

/// Every plugin that a command can name: those of this build, of the shared objects in the folders of
/// FROND_PLUGIN_PATH, and of `files`. Throws InputError.
Registry load_registry(std::span<const std::string> files);

}  // namespace frond
