#pragma once

#include <vector>

#include "core/integrator.h"
#include "integrators/path_tracer.h"

namespace frond {

/// What the integrator `path` decides before a render, from paths of a few pixels.

/// Materials, by id, that reflect and transmit light and return at least 3/4 of it, where camera rays meet them.
/// Throws SurfaceError.
std::vector<bool> bright_materials(const World& world, const PilotRays& rays);

/// Whether two rays scattered at all first hits have less variance times CPU time than one. For scenes in which no
/// light is sampled: elsewhere the rare paths with much light make the pilot's estimate too noisy. Throws SurfaceError.
bool two_rays_pay(const World& world, const LightSelector& selector, PathSettings settings, const PilotRays& rays);

/// The same for two light samples at the first hit.
bool two_light_samples_pay(const World& world, const LightSelector& selector, PathSettings settings,
                           const PilotRays& rays);

}  // namespace frond
