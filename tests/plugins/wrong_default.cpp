#include "core/plugin_module.h"

/// A parameter whose default is no number.
namespace {

constexpr frond::Param kParams[] = {
    {.name = "depth", .kind = frond::ParamKind::real, .default_value = std::string_view("deep"), .doc = "A number."}};
std::unique_ptr<frond::Light> make(const frond::Params&, const frond::Transform&) { return nullptr; }
const frond::LightInfo kLight{{"light", "deep", "", "", kParams}, make};
const frond::LightInfo* const kLights[] = {&kLight};

}  // namespace

const frond::PluginModule* frond_plugin() {
  static const frond::PluginModule module{.lights = kLights};
  return &module;
}
