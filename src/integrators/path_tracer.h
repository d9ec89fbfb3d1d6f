#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/integrator.h"
#include "integrators/light_selector.h"
#include "integrators/vertex_numbers.h"

namespace frond {

/// Values of the parameters of integrator `path`.
struct PathSettings {
  int max_depth;
  bool sample_lights;
  int light_samples;   ///< at the first vertex, 1 to kMostSplit; one where all lights are points or directions
  int scattered_rays;  ///< at the first vertex where the surface is not a mirror, 1 to kMostSplit
  bool cut_off_attenuation;
  float cutoff;
  bool regularizes;
  bool hides_background;
  /// The same as scattered_rays by SurfacePoint::material_id, for the materials before the vector's end.
  std::vector<int> rays_by_material;
};

/// What each light sample and each scattered ray of the first vertices of a bundle finds, by path.
struct SplitRecord {
  struct Part {
    LaneSet paths;                                              ///< whose first vertex takes this sample
    std::array<SampledSpectrum, PathBundle::kMost> radiance{};  ///< as it counts in the result
    std::array<int, PathBundle::kMost> rays{};                  ///< number of rays, including those of later vertices
  };
  using Parts = std::array<Part, kMostSplit>;
  Parts lights, scattered;
};

/// Returns a tracer for one thread. The arguments must outlive it. With a record, each call overwrites it, and the
/// first samples of a bundle's first vertices are distributed like those of paths that take one, and so are the second
/// ones.
std::unique_ptr<Tracer> make_path_tracer(const World& world, const LightSelector& selector,
                                         const PathSettings& settings, SplitRecord* record = nullptr);

}  // namespace frond
