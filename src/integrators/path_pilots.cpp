#include "integrators/path_pilots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "integrators/lane_set.h"
#include "integrators/path_parts.h"

namespace frond {
namespace {

/// CPU time of a camera ray, and of a light sample at a first vertex without its shadow ray and of that ray, with what
/// is done for them, in units of that of a scattered ray (measured).
constexpr double kCameraRay = 0.6, kLightSample = 0.15, kShadowRay = 0.45;

/// Share of edges in the variance of 64 samples, the usual number, relative to that in the variance of a bundle's.
constexpr double kEdges = 0.57;

using Color = std::array<double, 3>;

/// What a second sample changes: sums over bundles.
struct SecondSample {
  double saved = 0;  ///< variance of a bundle's sum
  double rays = 0;   ///< number of rays that it adds
};

/// Taking two samples instead of one.
struct Option {
  double saved, cost;  ///< variance and CPU time
  int* count;          ///< the number of samples
};

/// Variance of a pixel by its cause.
struct Noise {
  double later;  ///< random numbers after those of the camera ray
  double edges;  ///< places of the camera rays

  /// Variance in the same time, if a path takes `cost` times as long, relative to that of `later` with as many more
  /// samples per pixel. That at edges falls faster: with the power 1.5 of their number instead of 1.1 (measured).
  double in_same_time(double cost) const { return later * cost + edges * std::pow(cost, 1.4); }
};

/// Takes those options with which images have least variance in the same time. Of all sets, the best one consists of
/// the options that save most for their cost. `cost` is the CPU time without them.
void take_best(std::vector<Option> options, Noise noise, double cost) {
  std::erase_if(options, [](const Option& o) { return !(o.saved > 0 && o.cost > 0); });
  std::ranges::stable_sort(options, std::greater(), [](const Option& o) { return o.saved / o.cost; });
  double least = noise.in_same_time(1), relative_cost = 1;
  size_t best = 0;
  for (size_t i = 0; i < options.size(); ++i) {
    noise.later = std::max(0., noise.later - options[i].saved);
    relative_cost += options[i].cost / cost;
    const double after = noise.in_same_time(relative_cost);
    if (after < least) least = after, best = i + 1;
  }
  for (size_t i = 0; i < best; ++i) *options[i].count = 2;
}

/// Paths of a few pixels, two bundles of each, whose first vertices take two samples where their number is to be
/// selected. All sums are over bundles.
class Pilot {
 public:
  Pilot(const World& world, const LightSelector& selector, const PathSettings& settings, const PilotRays& rays)
      : rays_(rays), tracer_(make_path_tracer(world, selector, settings, &record_)) {}

  SecondSample light;
  std::map<uint32_t, SecondSample> scattered;  ///< by material
  double variance = 0;                         ///< of a bundle's sum
  double camera_rays = 0, hits = 0;            ///< numbers of camera rays, and of light samples with or without a ray
  double shadow_rays = 0;                      ///< number of rays of the first light samples
  double traced = 0;                           ///< number of all rays

  void add_pixel(uint64_t pixel) {
    Color difference{};
    for (const uint64_t which : {0, 1}) {
      PathBundle bundle = rays_.bundle(pixel, which);
      tracer_->trace(bundle);
      for (size_t i = 0; i < bundle.results.size(); ++i)
        add(difference, bundle, i, bundle.results[i].radiance, which == 0);
      add(light, bundle, record_.lights, LaneSet(bundle.lanes));
      std::map<uint32_t, LaneSet> by_material;
      for (const size_t i : LaneSet(bundle.lanes))
        if (bundle.results[i].first.is_hit) by_material[bundle.results[i].first.material].add(i);
      for (const auto& [material, paths] : by_material) add(scattered[material], bundle, record_.scattered, paths);
      camera_rays += double(bundle.results.size());
      hits += double(record_.lights[0].paths.size());
      shadow_rays += std::accumulate(record_.lights[0].rays.begin(), record_.lights[0].rays.end(), 0.);
      traced += double(bundle.traced);
    }
    add_square(difference, variance);
  }

 private:
  /// Adds or subtracts the colour of a path.
  void add(Color& sum, const PathBundle& bundle, size_t path, const SampledSpectrum& radiance, bool is_positive) const {
    const Color color = rays_.color(radiance, bundle.lambda[path]);
    for (size_t c = 0; c < 3; ++c) sum[c] += is_positive ? color[c] : -color[c];
  }

  static void add_square(const Color& color, double& sum) {
    const double square = color[0] * color[0] + color[1] * color[1] + color[2] * color[2];
    if (std::isfinite(square)) sum += square;
  }

  /// Adds what first and second samples found, which count half each. The variance of their mean is less than that of
  /// one of them by a quarter of the mean squared difference of the two, also where they are correlated.
  void add(SecondSample& effect, const PathBundle& bundle, const SplitRecord::Parts& parts,
           const LaneSet& paths) const {
    Color difference{};  // half of that between the samples
    for (const size_t i : LaneSet(paths.bits() & parts[1].paths.bits())) {
      add(difference, bundle, i, parts[0].radiance[i], true);
      add(difference, bundle, i, parts[1].radiance[i], false);
      effect.rays += parts[1].rays[i];
    }
    add_square(difference, effect.saved);
  }

  const PilotRays& rays_;
  SplitRecord record_;
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace

void adapt_to_scene(const World& world, const LightSelector& selector, const AdaptedSettings& adapted,
                    const PilotRays& rays, PathSettings& settings) {
  constexpr double kMostRays = 1 << 17;
  constexpr uint64_t kMostPixels = 1024;
  PathSettings twice = settings;
  if (adapted.light_samples) twice.light_samples = 2;
  if (adapted.scattered_rays) twice.scattered_rays = 2;
  Pilot pilot(world, selector, twice, rays);
  for (uint64_t pixel = 0; pixel < kMostPixels && pilot.traced < kMostRays; ++pixel) {
    check_stop();
    pilot.add_pixel(pixel);
  }

  std::vector<Option> options;
  double saved = 0;
  double cost = pilot.traced - (1 - kCameraRay) * pilot.camera_rays - (1 - kShadowRay) * pilot.shadow_rays;
  if (adapted.light_samples) {
    saved += pilot.light.saved;
    cost += kLightSample * pilot.hits - pilot.light.rays;
    options.push_back(
        {pilot.light.saved, kLightSample * pilot.hits + kShadowRay * pilot.light.rays, &settings.light_samples});
  }
  if (adapted.scattered_rays && !pilot.scattered.empty()) {
    settings.rays_by_material.resize(pilot.scattered.rbegin()->first + 1, settings.scattered_rays);
    for (const auto& [material, second] : pilot.scattered) {
      saved += second.saved;
      cost -= second.rays;
      options.push_back({second.saved, second.rays, &settings.rays_by_material[material]});
    }
  }
  // With two samples, as much variance is left as the second one has saved.
  take_best(options, {.later = 2 * saved, .edges = kEdges * std::max(0., pilot.variance - saved)}, cost);
}

}  // namespace frond
