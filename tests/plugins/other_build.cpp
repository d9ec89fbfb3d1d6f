// Compiled with tests/plugins/other_build in front: as if against the headers of another frond.
#include "core/plugin_module.h"

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module;
  return &module;
}
