#include "integrators/path_pilots.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "integrators/path_parts.h"

namespace frond {
namespace {

constexpr uint64_t kPixels = 256;

/// Noise and cost of paths. A sample of the noise is half the squared difference of the mean radiances of two bundles
/// of a pixel.
class PathPilot {
 public:
  PathPilot(const World& world, const LightSelector& selector, const PathSettings& settings)
      : settings_(settings), tracer_(make_path_tracer(world, selector, settings_)) {}

  void add(PathBundle a, PathBundle b) {
    const double difference = radiance(a) - radiance(b);
    if (std::isfinite(difference)) variance_ += difference * difference / 2;
  }
  double variance() const { return variance_; }  ///< sum over the pairs
  double rays() const { return double(rays_); }

 private:
  double radiance(PathBundle& bundle) {
    tracer_->trace(bundle);
    rays_ += bundle.traced;
    double sum = 0;
    for (size_t i = 0; i < bundle.results.size(); ++i)
      sum += double(mean(bundle.results[i].radiance, bundle.lambda[i]));
    return sum / double(bundle.results.size());
  }

  PathSettings settings_;
  std::unique_ptr<Tracer> tracer_;
  double variance_ = 0;
  uint64_t rays_ = 0;
};

/// The same camera rays, followed by other random numbers.
PathBundle with_other_numbers(PathBundle bundle) {
  constexpr uint32_t kFar = 1 << 24;  // beyond the dimensions of any path
  bundle.dimension += kFar;
  for (uint64_t& key : bundle.keys) key = hash_key(key, kFar);
  return bundle;
}

/// Whether paths with `two` samples at the first hit have less variance times CPU time than paths with `one`. What the
/// second sample saves is variance for given camera rays; that of whole pixels would show it as well, with more noise.
/// `whole` are paths with two samples. A ray of the second sample adds `cost` times the CPU time per other ray.
bool pays(PathPilot& one, PathPilot& two, PathPilot& whole, double cost, const PilotRays& rays) {
  for (uint64_t pixel = 0; pixel < kPixels; ++pixel) {
    check_stop();
    const PathBundle bundle = rays.bundle(pixel, 0), other = with_other_numbers(bundle);
    whole.add(bundle, rays.bundle(pixel, 1));
    two.add(bundle, other);
    one.add(bundle, other);
  }
  const double second = two.rays() - one.rays(), rest = whole.rays() - second;
  return rest > 0 && one.variance() - two.variance() > whole.variance() * cost * second / rest;
}

/// Estimates the albedo of the material at `point`, where a camera ray of the bundle meets it; empty if it does not
/// reflect and transmit light.
std::optional<double> two_sided_albedo(const SurfacePoint& point, const PathBundle& bundle, size_t ray, Arena& arena) {
  const SampledWavelengths& lambda = bundle.lambda[ray];
  arena.reset();
  const Bsdf* bsdf = point.material->evaluate(point.hit, lambda, arena);
  if (!bsdf || !is_rough(*bsdf)) return {};
  const Lobes lobes = bsdf->flags();
  if (!any(lobes & Lobes::reflection) || !any(lobes & Lobes::transmission)) return {};
  LocalBsdf local;
  local.set(*bsdf, point.hit, -bundle.rays[ray].d);
  return double(mean(local.albedo(1, bundle.keys[ray]), lambda));
}

}  // namespace

std::vector<bool> bright_materials(const World& world, const PilotRays& rays) {
  constexpr size_t kStep = 4;  // every fourth camera ray
  constexpr double kLeastAlbedo = 0.75;
  std::vector<double> excess;  // by material: sum of albedos less kLeastAlbedo
  std::vector<bool> is_met;
  Arena arena;
  SurfacePoint point;
  const SurfacePoint* const at = &point;
  for (uint64_t pixel = 0; pixel < kPixels; ++pixel) {
    check_stop();
    const PathBundle bundle = rays.bundle(pixel, 0);
    for (size_t i = 0; i < bundle.rays.size(); i += kStep) {
      if (!world.intersect(bundle.rays[i], bundle.keys[i], point)) continue;
      std::optional<double> albedo;
      with_surface_of_errors(at, [&] { albedo = two_sided_albedo(point, bundle, i, arena); });
      if (!albedo) continue;
      if (excess.size() <= point.material_id) excess.resize(point.material_id + 1), is_met.resize(excess.size());
      excess[point.material_id] += *albedo - kLeastAlbedo;
      is_met[point.material_id] = true;
    }
  }
  for (size_t i = 0; i < excess.size(); ++i) is_met[i] = is_met[i] && excess[i] >= 0;
  return is_met;
}

bool two_rays_pay(const World& world, const LightSelector& selector, PathSettings settings, const PilotRays& rays) {
  // Measured, a ray of the second path takes 1.1 to 1.4 times as long as another ray. The cost is lower, because edges,
  // whose noise a second ray does not reduce, have a larger share in the pilot's 16 samples than in pixels of more.
  constexpr double kCost = 0.75;
  settings.scattered_rays = 2;
  PathPilot whole(world, selector, settings), two(world, selector, settings);
  settings.scattered_rays = 1;
  PathPilot one(world, selector, settings);
  return pays(one, two, whole, kCost, rays);
}

bool two_light_samples_pay(const World& world, const LightSelector& selector, PathSettings settings,
                           const PilotRays& rays) {
  // Measured, a light sample with its ray adds 0.5 to 0.8 of the time that the rest of a path takes for each of its
  // rays.
  constexpr double kCost = 2. / 3;
  settings.light_samples = 2;
  PathPilot whole(world, selector, settings);
  settings.max_depth = std::min(settings.max_depth, 1);
  PathPilot two(world, selector, settings);
  settings.light_samples = 1;
  PathPilot one(world, selector, settings);
  return pays(one, two, whole, kCost, rays);
}

}  // namespace frond
