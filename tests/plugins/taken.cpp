#include "core/plugin_module.h"

/// A material under a name that the built-in table has.
namespace {

const frond::MaterialInfo kDiffuse{{"material", "diffuse", "", "", {}}, nullptr};
const frond::MaterialInfo* const kMaterials[] = {&kDiffuse};

}  // namespace

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.materials = kMaterials};
  return &module;
}
