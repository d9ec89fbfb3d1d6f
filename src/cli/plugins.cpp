#include "cli/plugins.h"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "cli/commands.h"
#include "scene/plugin_library.h"

namespace frond {

void add_plugin_option(CLI::App& command, std::vector<std::string>& files) {
  command
      .add_option(
          "--plugin", files,
          "Shared object with further plugins; may be given again. Those in the folders of FROND_PLUGIN_PATH are "
          "loaded by themselves.")
      ->allow_extra_args(false);
}

Registry load_registry(std::span<const std::string> files) {
  Registry registry = builtin_registry();
  if (const char* folders = std::getenv("FROND_PLUGIN_PATH"))
    for (const auto& file : plugins_in(folders)) load_plugin(file, registry);
  for (const std::string& file : files) load_plugin(file, registry);
  return registry;
}

}  // namespace frond
