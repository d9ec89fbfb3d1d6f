#pragma once

#include "core/light.h"
#include "core/plugin.h"
#include "core/transform.h"
#include "scene/shape.h"

namespace frond {

struct LightInfo : PluginInfo {
  std::unique_ptr<Light> (*make)(const Params&, const Transform& world_from_light);
};

/// Makes one area light: Lambertian emission over a shape. `geometry` is in world space and is kept.
struct AreaLightInfo : PluginInfo {
  std::unique_ptr<AreaLight> (*make)(const Params&, const ShapeGeometry& geometry);
};

}  // namespace frond
