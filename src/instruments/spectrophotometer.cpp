#include "instruments/spectrophotometer.h"

#include <cmath>

namespace frond {
namespace {

/// Tally of exits. Each ray adds to one class, or to none if absorbed.
struct ShareTally {
  float lit_side;  ///< sign of the light's cos theta
  Moments surface = {}, subsurface = {}, transmitted = {};

  void add(const Scattered& ray) {
    const float weight = ray.weight[0];
    if (weight == 0) return;
    const bool reflected = ray.direction.z * lit_side > 0;
    const bool from_surface = any(ray.lobe & Lobes::surface);
    (!reflected ? transmitted : from_surface ? surface : subsurface).add(double(weight));
  }
  void add(const ShareTally& other) {
    surface.add(other.surface);
    subsurface.add(other.subsurface);
    transmitted.add(other.transmitted);
  }
  void clear() { surface = subsurface = transmitted = {}; }
};

/// Mean over all rays; the rays of other classes count as 0.
Estimate share(const Moments& added, int64_t rays) {
  Moments all = added;
  all.add_zeros(rays - added.count());
  return all.estimate();
}

Moments sum(Moments a, const Moments& b) {
  a.add(b);
  return a;
}

Estimate one_minus(const Estimate& e) { return {1 - e.mean, e.variance, -e.third_cumulant}; }

SpectrophotometerMeasurement measurement_of(const ShareTally& tally, int64_t rays,
                                            SpectrophotometerMeasurement measurement) {
  const Moments reflected = sum(tally.surface, tally.subsurface);
  measurement.rays = rays;
  measurement.surface = share(tally.surface, rays);
  measurement.subsurface = share(tally.subsurface, rays);
  measurement.reflectance = share(reflected, rays);
  measurement.transmittance = share(tally.transmitted, rays);
  measurement.absorptance = one_minus(share(sum(reflected, tally.transmitted), rays));
  return measurement;
}

int64_t whole_blocks(double rays, int64_t most) {
  const double blocks = std::ceil(rays / double(kRaysPerBlock));
  return blocks * double(kRaysPerBlock) >= double(most) ? most : int64_t(blocks) * kRaysPerBlock;
}

int64_t first_ray_count(const RayBudget& budget) {
  return budget.standard_error > 0 ? whole_blocks(2 / budget.standard_error, budget.rays) : budget.rays;
}

/// Total number of rays expected to suffice. An early error may be inaccurate, so a round increases the total at most
/// eightfold.
int64_t next_ray_count(const SpectrophotometerMeasurement& so_far, const RayBudget& budget) {
  constexpr double kMargin = 1.02;
  const double ratio = so_far.standard_error() / budget.standard_error, done = double(so_far.rays);
  return whole_blocks(std::max(done + 1, done * std::min(8.0, kMargin * ratio * ratio)), budget.rays);
}

}  // namespace

double SpectrophotometerMeasurement::standard_error() const {
  return std::max({reflectance.standard_error(), transmittance.standard_error(), absorptance.standard_error()});
}

SpectrophotometerMeasurement measure_shares(const LitMaterial& lit, const RayBudget& budget, const ThreadPool& pool,
                                            const RayProgress& progress) {
  check_beam(lit.beam);
  check_rays(budget.rays);
  check_as_rendered(lit);
  Arena arena;
  SpectrophotometerMeasurement measurement{.beam = lit.beam};
  measurement.distinguishes_surface =
      any(bsdf_of(lit.material, lit.beam, arena).flags() & Lobes::surface) && !lit.as_rendered;
  ShareTally tally{.lit_side = toward_light(lit.beam).z};
  for (int64_t end = first_ray_count(budget);; end = next_ray_count(measurement, budget)) {
    tally_rays(lit, measurement.rays, end, tally, pool, progress);
    measurement = measurement_of(tally, end, measurement);
    if (end == budget.rays || measurement.standard_error() <= budget.standard_error) return measurement;
  }
}

}  // namespace frond
