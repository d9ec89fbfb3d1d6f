#pragma once

#include "instruments/detector_sphere.h"
#include "instruments/rays.h"
#include "instruments/statistics.h"

namespace frond {

/// What the detectors saw.
struct GoniophotometerReading {
  Beam beam;
  DetectorSphere sphere;
  int64_t rays = 0;
  std::vector<Moments> caught;  ///< weights of the rays in each patch

  /// BRDF (on the lit side) or BTDF in 1/sr, mean over the patch: weight sum / (rays * projected solid angle). The
  /// error of a patch that no ray has reached is 0: its f is below about 3 / (rays * projected solid angle).
  Estimate f(size_t patch) const;
  bool is_reflected(const Patch& patch) const { return (patch.theta_deg() < 90) == (beam.theta_deg <= 90); }
};

/// Throws InputError where the material has a delta lobe: all of its light would fall into one patch and "f" would be
/// whatever the patch's size makes of it.
void check_no_delta_lobe(const Exposure& exposure);

/// Measures BRDF and BTDF over the whole sphere: light comes in along the direction that the material's model calls
/// incident. Deterministic: depends on the exposure and the number of rays alone. Throws InputError for fewer than
/// 2 rays, a beam out of range, a delta lobe, and weights that are not numbers.
GoniophotometerReading measure_f(const Exposure& exposure, const DetectorSphere& sphere, int64_t rays,
                                 const ThreadPool& pool, const RayProgress& progress = {});

}  // namespace frond
