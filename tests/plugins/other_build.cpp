#include "core/plugin_module.h"

/// A plug-in that seems to be compiled with the headers of another frond, in which `core/math/vec.h` differs.
namespace {
[[gnu::used, gnu::section("frond_headers")]] const char kOther[] = "core/math/vec.h 0123456789abcdef";
}

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module;
  return &module;
}
