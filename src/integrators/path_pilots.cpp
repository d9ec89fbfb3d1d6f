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

/// The variance falls with these powers of the number of samples of a pixel: that at edges faster than the rest
/// (measured, with the sampler "lattice").
constexpr double kPower = 1.1, kPowerAtEdges = 1.5;

/// From the squared difference of two bundles, at edges, to their variance for 64 samples, the usual number, relative
/// to that of the rest. The two are halves of one lattice: their difference has the error that all of their samples do
/// not have, so that its square is 4 (1 - 2^-power) times the variance of a bundle.
const double kEdges = std::pow(64. / PathBundle::kMost, kPower - kPowerAtEdges) / (2 * (1 - std::exp2(-kPowerAtEdges)));

using Color = std::array<double, 3>;

/// What a second sample changes: sums over bundles.
struct SecondSample {
  double saved = 0;  ///< variance of a bundle's sum
  double cost = 0;   ///< CPU time
};

/// Taking two samples instead of one.
struct Option {
  SecondSample second;
  int* count;  ///< the number of samples
};

/// Variance of a pixel by its cause.
struct Noise {
  double later;  ///< random numbers of light samples and scattered rays
  double edges;  ///< the rest, which is taken as that of the places of camera rays

  /// Variance in the same time, if a path takes `cost` times as long, relative to cost^(kPower - 1).
  double in_same_time(double cost) const { return later * cost + edges * std::pow(cost, 1 + kPowerAtEdges - kPower); }
};

/// Takes those options with which images have least variance in the same time, of the sets of those that save most for
/// their cost. (Without edges the best set is one of these.) `cost` is the CPU time without options.
void take_best(std::vector<Option> options, Noise noise, double cost) {
  std::erase_if(options, [](const Option& o) { return !(o.second.saved > 0 && o.second.cost > 0); });
  std::ranges::stable_sort(options, std::greater(), [](const Option& o) { return o.second.saved / o.second.cost; });
  double least = noise.in_same_time(1), relative_cost = 1;
  size_t best = 0;
  for (size_t i = 0; i < options.size(); ++i) {
    noise.later = std::max(0., noise.later - options[i].second.saved);
    relative_cost += options[i].second.cost / cost;
    const double after = noise.in_same_time(relative_cost);
    if (after < least) least = after, best = i + 1;
  }
  for (size_t i = 0; i < best; ++i) *options[i].count = 2;
}

/// Paths of a few pixels, two bundles of each, whose first vertices take two of both. All sums are over bundles.
class Pilot {
 public:
  Pilot(const World& world, const LightSelector& selector, const PathSettings& settings, const PilotRays& rays)
      : rays_(rays), tracer_(make_path_tracer(world, selector, settings, &record_)) {}

  SecondSample light;
  std::map<uint32_t, SecondSample> scattered;  ///< by material
  double variance = 0;                         ///< of a bundle's sum
  double cost = 0;                             ///< CPU time
  uint64_t rays_traced = 0;

  void add_pixel(uint64_t pixel) {
    Color difference{};
    for (const uint64_t which : {0, 1}) {
      PathBundle bundle = rays_.bundle(pixel, which);
      tracer_->trace(bundle);
      for (size_t i = 0; i < bundle.results.size(); ++i)
        add(difference, bundle, i, bundle.results[i].radiance, which == 0);
      add(light, bundle, record_.lights, LaneSet(bundle.lanes));
      light.cost += light_cost(record_.lights[1]);
      std::map<uint32_t, LaneSet> by_material;
      for (const size_t i : LaneSet(bundle.lanes))
        if (bundle.results[i].first.is_hit) by_material[bundle.results[i].first.material].add(i);
      for (const auto& [material, paths] : by_material) {
        add(scattered[material], bundle, record_.scattered, paths);
        for (const size_t i : paths) scattered[material].cost += record_.scattered[1].rays[i];
      }
      cost += double(bundle.traced) - (1 - kCameraRay) * double(bundle.results.size());
      for (const SplitRecord::Part& part : record_.lights) cost += light_cost(part) - rays_of(part);
      rays_traced += bundle.traced;
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

  static double rays_of(const SplitRecord::Part& part) {
    return std::accumulate(part.rays.begin(), part.rays.end(), 0.);
  }
  static double light_cost(const SplitRecord::Part& part) {
    return kLightSample * double(part.paths.size()) + kShadowRay * rays_of(part);
  }

  /// Adds what first and second samples found, which count half each. The variance of their mean is less than that of
  /// one of them by a quarter of the mean squared difference of the two, also where they are correlated.
  void add(SecondSample& effect, const PathBundle& bundle, const SplitRecord::Parts& parts,
           const LaneSet& paths) const {
    Color difference{};  // half of that between the samples
    for (const size_t i : LaneSet(paths.bits() & parts[1].paths.bits())) {
      add(difference, bundle, i, parts[0].radiance[i], true);
      add(difference, bundle, i, parts[1].radiance[i], false);
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
  constexpr uint64_t kMostRays = 1 << 17;
  constexpr uint64_t kMostPixels = 1024;
  PathSettings two = settings;
  two.light_samples = two.scattered_rays = 2;
  Pilot pilot(world, selector, two, rays);
  for (uint64_t pixel = 0; pixel < kMostPixels && pilot.rays_traced < kMostRays; ++pixel) {
    check_stop();
    pilot.add_pixel(pixel);
  }

  // From two of both to what the settings state, and one of what is to be selected.
  Noise noise{.later = 0, .edges = pilot.variance};
  double cost = pilot.cost;
  std::vector<Option> options;
  const auto consider = [&](const SecondSample& second, bool is_open, int& count) {
    // With two samples, as much variance is left as the second one has saved.
    noise.edges -= second.saved;
    noise.later += count == 1 ? 2 * second.saved : second.saved;
    if (count == 1) cost -= second.cost;
    if (is_open) options.push_back({second, &count});
  };
  consider(pilot.light, adapted.light_samples, settings.light_samples);
  if (adapted.scattered_rays && !pilot.scattered.empty())
    settings.rays_by_material.resize(pilot.scattered.rbegin()->first + 1, settings.scattered_rays);
  for (const auto& [material, second] : pilot.scattered)
    consider(second, adapted.scattered_rays,
             adapted.scattered_rays ? settings.rays_by_material[material] : settings.scattered_rays);
  noise.edges = kEdges * std::max(0., noise.edges);
  take_best(options, noise, cost);
}

}  // namespace frond
