#include "core/plugin_module.h"

/// A material whose record states another kind.
namespace {

const frond::MaterialInfo kLost{{"light", "lost", "", "", {}}, nullptr};
const frond::MaterialInfo* const kMaterials[] = {&kLost};

}  // namespace

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.materials = kMaterials};
  return &module;
}
