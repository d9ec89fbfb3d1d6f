#include "core/plugin_module.h"

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.interface_version = frond::kPluginInterface + 1};
  return &module;
}
