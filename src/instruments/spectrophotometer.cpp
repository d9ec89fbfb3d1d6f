#include "instruments/spectrophotometer.h"

#include <cmath>

namespace frond {
namespace {

/// Where rays have gone. Each adds to one class or, where it was absorbed, to none.
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

/// The mean over all rays of what some of them added.
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

SpectrophotometerReading reading_of(const ShareTally& tally, int64_t rays, SpectrophotometerReading reading) {
  const Moments reflected = sum(tally.surface, tally.subsurface);
  reading.rays = rays;
  reading.surface = share(tally.surface, rays);
  reading.subsurface = share(tally.subsurface, rays);
  reading.reflectance = share(reflected, rays);
  reading.transmittance = share(tally.transmitted, rays);
  reading.absorptance = one_minus(share(sum(reflected, tally.transmitted), rays));
  if (!std::isfinite(reading.absorptance.mean + reading.absorptance.variance))
    fail({}, "the material scattered light with a weight that is not a number, at {} degrees and {} nm",
         reading.beam.theta_deg, reading.beam.lambda_nm);
  return reading;
}

int64_t whole_blocks(double rays, int64_t most) {
  const double blocks = std::ceil(rays / double(kRaysPerBlock));
  return blocks * double(kRaysPerBlock) >= double(most) ? most : int64_t(blocks) * kRaysPerBlock;
}

int64_t first_round(const Dose& dose) {
  return dose.standard_error > 0 ? whole_blocks(2 / dose.standard_error, dose.rays) : dose.rays;
}

/// How many rays in all should do. An early error may be far off, so a round grows the total eightfold at most.
int64_t next_round(const SpectrophotometerReading& so_far, const Dose& dose) {
  constexpr double kMargin = 1.02;
  const double ratio = so_far.standard_error() / dose.standard_error, done = double(so_far.rays);
  return whole_blocks(std::max(done + 1, done * std::min(8.0, kMargin * ratio * ratio)), dose.rays);
}

}  // namespace

double SpectrophotometerReading::standard_error() const {
  return std::max({reflectance.standard_error(), transmittance.standard_error(), absorptance.standard_error()});
}

SpectrophotometerReading measure_shares(const Exposure& exposure, const Dose& dose, const ThreadPool& pool,
                                        const RayProgress& progress) {
  check_beam(exposure.beam);
  check_rays(dose.rays);
  check_as_rendered(exposure);
  Arena arena;
  SpectrophotometerReading reading{.beam = exposure.beam};
  reading.tells_surface =
      any(bsdf_of(exposure.material, exposure.beam, arena).flags() & Lobes::surface) && !exposure.as_rendered;
  ShareTally tally{.lit_side = toward_light(exposure.beam).z};
  for (int64_t end = first_round(dose);; end = next_round(reading, dose)) {
    shoot(exposure, reading.rays, end, tally, pool, progress);
    reading = reading_of(tally, end, reading);
    if (end == dose.rays || reading.standard_error() <= dose.standard_error) return reading;
  }
}

}  // namespace frond
