#include "core/plugin_module.h"

/// As if compiled against the headers of another frond: a plug-in. `core/math/vec.h` is another one there.
namespace {
[[gnu::used, gnu::section("frond_headers")]] const char kOther[] = "core/math/vec.h 0123456789abcdef";
}

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module;
  return &module;
}
