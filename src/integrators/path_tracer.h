#pragma once

#include <memory>
#include <vector>

#include "core/integrator.h"
#include "integrators/light_selector.h"

namespace frond {

/// Values of the parameters of integrator `path`.
struct PathSettings {
  int max_depth;
  bool sample_lights;
  int light_samples;  ///< at the first vertex
  /// Rays that first vertices scatter where surfaces are not mirrors; 0: two where materials are `bright`, else one.
  int scattered_rays;
  bool cut_off_attenuation;
  float cutoff;
  bool regularizes;
  /// By SurfacePoint::material_id: materials whose first vertices scatter two rays. One that lies beyond the end does
  /// not.
  std::vector<bool> bright;
};

/// Returns a tracer for one thread. The arguments must outlive it.
std::unique_ptr<Tracer> make_path_tracer(const World& world, const LightSelector& selector,
                                         const PathSettings& settings);

}  // namespace frond
