#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "core/bssrdf.h"
#include "core/integrator.h"
#include "integrators/light_selector.h"
#include "integrators/vertex_numbers.h"

namespace frond {

/// Russian roulette: a path survives with the probability scale T / full, where T is its throughput; that of each of
/// two rays of a first vertex counts half. `full` is 1; after the first kSafeScatterings - 1 scatterings at most what
/// the path has found, relative to the mean over the image. Hence paths survive that have found nothing, such as those
/// in shadows, and few end where that would be seen.
struct Roulette {
  float scale = 2;
  /// Radiance of a path, mean over the image. Infinity: the first scatterings end no path; 0: `full` is always 1.
  float mean = INFINITY;
};

/// Values of the parameters of integrator `path`.
struct PathSettings {
  int max_depth;
  bool sample_lights;
  int light_samples;   ///< at the first vertex, 1 to kMostSplit; one where all lights are points or directions
  int scattered_rays;  ///< at the first vertex where the surface is not a mirror, 1 to kMostSplit
  bool cut_off_attenuation;
  float cutoff;
  Roulette roulette;
  bool regularizes;
  bool hides_background;
  /// scattered_rays by SurfacePoint::material_id; materials beyond the end have scattered_rays.
  std::vector<int> rays_by_material;
  SubsurfaceMaterials subsurface;
};

/// Radiance and rays of each light sample and of each scattered ray of the first vertices of a bundle, by path: the
/// recorder of a PathTracer for pilots. Between `begin` and the first selection nothing is recorded.
class SplitRecord {
 public:
  struct Part {
    LaneSet paths;                                              ///< whose first vertex takes this sample
    std::array<SampledSpectrum, PathBundle::kSize> radiance{};  ///< as it counts in the result
    std::array<int, PathBundle::kSize> rays{};                  ///< number of rays, including those of later vertices
    std::array<float, PathBundle::kSize> share{};               ///< of scattered rays: as roulette sees the throughput
  };
  using Parts = std::array<Part, kMostSplit>;
  Parts lights, scattered;

  /// The first samples of a bundle's first vertices are distributed like those of paths that take one, and so are the
  /// second ones.
  static constexpr bool kSeparatesSamples = true;
  void begin() { *this = {}; }
  /// Selects light sample `which` of the first vertices of these paths for the radiance and the rays that follow.
  void select_light_sample(int which, const LaneSet& paths) {
    selected_ = &lights[size_t(which)];
    selected_->paths = paths;
  }
  /// Selects scattered ray `which` of the first vertices.
  void select_scattered_ray(int which) { selected_ = &scattered[size_t(which)]; }
  /// Adds a path whose first vertex scatters this many rays.
  void add_path(size_t lane, int rays) {
    for (int which = 0; which < rays; ++which) scattered[size_t(which)].paths.add(lane);
  }
  /// Adds a scattered ray of a first vertex.
  void add_scattered(size_t lane, int which, float share) { scattered[size_t(which)].share[lane] = share; }
  void add_radiance(size_t lane, const SampledSpectrum& radiance) {
    if (selected_) selected_->radiance[lane] += radiance;
  }
  void add_rays(const LaneSet& lanes) {
    if (!selected_) return;
    for (const size_t i : lanes) ++selected_->rays[i];
  }

 private:
  Part* selected_ = nullptr;
};

/// Returns a tracer for one thread. The arguments must outlive it.
std::unique_ptr<Tracer> make_path_tracer(const World& world, const LightSelector& selector,
                                         const PathSettings& settings);

/// The same for pilots: each call of `trace` overwrites the record.
std::unique_ptr<Tracer> make_recording_tracer(const World& world, const LightSelector& selector,
                                              const PathSettings& settings, SplitRecord& record);

}  // namespace frond
