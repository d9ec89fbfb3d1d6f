#pragma once

#include "core/light.h"
#include "core/plugin.h"
#include "core/transform.h"
#include "scene/lights/emitter.h"

namespace frond {

struct LightInfo : PluginInfo {
  std::unique_ptr<Light> (*make)(const Params&, const Transform& world_from_light);
};

/// What an AreaLightSource says, of any number of surfaces, which share its spectrum and image.
class AreaEmission {
 public:
  virtual ~AreaEmission() = default;
  /// It states a total, which is that of each face of a shape, as in pbrt-v4: each is a light of its own.
  virtual bool is_by_face() const = 0;
  virtual std::unique_ptr<AreaLight> over(EmittingSurface surface) const = 0;
};

struct AreaLightInfo : PluginInfo {
  std::unique_ptr<AreaEmission> (*make)(const Params&);
};

}  // namespace frond
