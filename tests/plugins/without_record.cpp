#include "core/plugin_module.h"

/// From headers that leave no record of themselves.

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module;
  return &module;
}
