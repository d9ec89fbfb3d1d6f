#pragma once

#include <memory>

#include "core/light.h"
#include "exports/mitsuba/context.h"

namespace frond::mitsuba {

/// A light that surrounds the scene.
struct Surroundings {
  const LightDescription& description;
  std::unique_ptr<Light> light;  ///< an EnvironmentLight
  int texels = 0;                ///< along a side of its image; 0: its radiance is the same everywhere
};

/// Writes the surrounding lights: a constant emitter if all are uniform, otherwise one environment image with their
/// sum, because Mitsuba takes one environment. The sun of a "sky" is a directional emitter.
void write_surroundings(Context& context, Xml& xml, const std::vector<Surroundings>& lights);

}  // namespace frond::mitsuba
