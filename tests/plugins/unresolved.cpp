#include "core/plugin_module.h"

namespace frond {
void gone_since_the_last_version();
}

const frond::PluginModule* frond_plugin() {
  frond::gone_since_the_last_version();
  return nullptr;
}
