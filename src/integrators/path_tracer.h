#pragma once

#include <memory>

#include "core/integrator.h"
#include "integrators/light_selector.h"

namespace frond {

/// Values of the parameters of integrator `path`.
struct PathSettings {
  int max_depth;
  bool sample_lights;
  int light_samples;  ///< at the first vertex
  bool cut_off_attenuation;
  float cutoff;
  bool regularizes;
};

/// Returns a tracer for one thread. The arguments must outlive it.
std::unique_ptr<Tracer> make_path_tracer(const World& world, const LightSelector& selector,
                                         const PathSettings& settings);

}  // namespace frond
