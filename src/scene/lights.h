#pragma once

#include "core/light.h"
#include "core/plugin.h"
#include "core/transform.h"
#include "scene/emitter.h"

namespace frond {

struct LightInfo : PluginInfo {
  std::unique_ptr<Light> (*make)(const Params&, const Transform& world_from_light);
};

/// Makes one area light: Lambertian emission over a shape.
struct AreaLightInfo : PluginInfo {
  std::unique_ptr<AreaLight> (*make)(const Params&, EmittingSurface surface);
};

}  // namespace frond
