#pragma once

#include <vector>

#include "core/integrator.h"
#include "integrators/path_tracer.h"

namespace frond {

/// Quantities that `adapt_to_scene` may select.
struct AdaptedSettings {
  bool light_samples;   ///< one or two
  bool scattered_rays;  ///< one or two by material
};

/// Selects how many light samples and scattered rays the first vertices of paths take, so that the product of an
/// image's variance and CPU time is smallest, by paths of a few pixels. Throws SurfaceError.
void adapt_to_scene(const World& world, const LightSelector& selector, const AdaptedSettings& adapted,
                    const PilotRays& rays, PathSettings& settings);

}  // namespace frond
