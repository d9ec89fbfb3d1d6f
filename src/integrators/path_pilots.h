#pragma once

#include "core/camera_samples.h"
#include "integrators/path_tracer.h"

namespace frond {

/// Quantities that `adapt_to_scene` may select.
struct AdaptedSettings {
  bool light_samples;   ///< one or two
  bool scattered_rays;  ///< one or two by material
  bool roulette;
};

/// Selects how many light samples and scattered rays the first vertices of paths take, and how soon roulette ends
/// paths, so that images have the least variance in the same CPU time, by paths of a few pixels of the whole image
/// (docs/internals.md). Throws SurfaceError.
void adapt_to_scene(const World& world, const LightSelector& selector, const AdaptedSettings& adapted,
                    const CameraSampling& sampling, PathSettings& settings);

}  // namespace frond
