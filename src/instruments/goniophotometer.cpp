#include "instruments/goniophotometer.h"

#include <cmath>

namespace frond {
namespace {

struct PatchTally {
  const DetectorSphere* sphere;
  std::vector<Moments> caught;

  void add(const Scattered& ray) {
    if (const float weight = ray.weight[0]; weight != 0) caught[sphere->find(ray.direction)].add(double(weight));
  }
  void add(const PatchTally& other) {
    for (size_t i = 0; i < caught.size(); ++i) caught[i].add(other.caught[i]);
  }
  void clear() { caught.assign(caught.size(), {}); }
};

void check_weights(const GoniophotometerReading& reading) {
  for (const Moments& m : reading.caught)
    if (!std::isfinite(m.mean() + m.variance()))
      fail({}, "the material scattered light with a weight that is not a number, at {} degrees and {} nm",
           reading.beam.theta_deg, reading.beam.lambda_nm);
}

}  // namespace

Estimate GoniophotometerReading::f(size_t patch) const {
  Moments all = caught[patch];
  all.add_zeros(rays - all.count());
  const Estimate share = all.estimate();
  const double scale = 1 / sphere.patch(patch).projected_solid_angle;
  return {share.mean * scale, share.variance * scale * scale, share.third_cumulant * scale * scale * scale};
}

void check_no_delta_lobe(const Exposure& exposure) {
  Arena arena;
  if (any(bsdf_of(exposure.material, exposure.beam, arena).flags() & Lobes::specular))
    fail({},
         "the material has a delta lobe, whose f no detector of finite size can measure; frond spectrophotometer "
         "measures its share of the light");
}

GoniophotometerReading measure_f(const Exposure& exposure, const DetectorSphere& sphere, int64_t rays,
                                 const ThreadPool& pool, const RayProgress& progress) {
  check_beam(exposure.beam);
  check_rays(rays);
  check_as_rendered(exposure);
  check_no_delta_lobe(exposure);
  GoniophotometerReading reading{exposure.beam, sphere, rays, {}};
  PatchTally tally{&sphere, std::vector<Moments>(sphere.size())};
  shoot(exposure, 0, rays, tally, pool, progress);
  reading.caught = std::move(tally.caught);
  check_weights(reading);
  return reading;
}

}  // namespace frond
