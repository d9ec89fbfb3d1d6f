#include "render/plugins.h"

#include <cstdlib>

#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/plugin_library.h"

namespace frond {

Registry builtin_registry() { return make_registry(builtin_materials(), builtin_integrators()); }

Registry load_registry(std::span<const std::string> files) {
  Registry registry = builtin_registry();
  if (const char* folders = std::getenv("FROND_PLUGIN_PATH"))
    for (const auto& file : plugins_in(folders)) load_plugin(file, registry);
  for (const std::string& file : files) load_plugin(file, registry);
  registry.materials.replace(open_leaf_of(registry.materials.all()));
  return registry;
}

}  // namespace frond
