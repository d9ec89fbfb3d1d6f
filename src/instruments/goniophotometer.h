#pragma once

#include "core/fluorescence.h"
#include "instruments/detector_sphere.h"
#include "instruments/errors/statistics.h"
#include "instruments/rays.h"

namespace frond {

/// Result of a goniophotometer.
struct GoniophotometerMeasurement {
  Beam beam;
  DetectorSphere sphere;
  int64_t rays = 0;                         ///< 0: no ray was traced, f was integrated
  std::vector<Moments> caught;              ///< weights of the rays in each patch; empty if f was integrated
  std::vector<double> integral;             ///< of f |cos theta| over each patch; empty if rays were traced
  std::vector<Estimate> fluorescence = {};  ///< f in each patch, 1/(sr nm); empty: the light is not fluorescence

  bool is_integrated() const { return rays == 0; }
  /// Number of rays that reached the patch.
  int64_t count(size_t patch) const { return caught.empty() ? 0 : caught[patch].count(); }
  /// Returns the BRDF (on the lit side) or BTDF in 1/sr, mean over the patch: weight sum / (rays * projected solid
  /// angle). The error of a patch that no ray has reached is 0; its f is below about 3 / (rays * projected solid
  /// angle).
  Estimate f(size_t patch) const;
  /// Whether the patch is on the lit side.
  bool is_reflected(const Patch& patch) const { return (patch.theta_deg() < 90) == (beam.theta_deg <= 90); }
  /// Share of the incident light that is reflected, or transmitted; of fluorescence photons per nm, Mb or Mf.
  Estimate share(bool reflected) const;
};

/// Throws InputError if the material has a delta lobe: all of its light would fall into one patch, and "f" would depend
/// on the patch's size.
void check_no_delta_lobe(const LitMaterial& lit);

/// Measures BRDF and BTDF over the whole sphere by tracing rays: light comes in along the incident direction of the
/// material's model. Deterministic: depends on `lit` and the number of rays alone. Throws InputError for fewer than 2
/// rays, a beam out of range, a delta lobe, and weights that are not numbers.
GoniophotometerMeasurement measure_f(const LitMaterial& lit, const DetectorSphere& sphere, int64_t rays,
                                     const ThreadPool& pool, const RayProgress& progress = {});

/// Whether `integrate_f` is applicable: f is not a random estimate.
bool has_exact_f(const LitMaterial& lit);

/// The same without noise: integrates f over each patch, with a relative error below 1e-4 where the density is smooth.
/// For materials with an exact f.
GoniophotometerMeasurement integrate_f(const LitMaterial& lit, const DetectorSphere& sphere, const ThreadPool& pool);

/// Measures fluorescence over the whole sphere: photon radiance per nm at the beam's wavelength of emission, over the
/// photon irradiance. An f that is a random estimate is averaged, over `rays` directions in all; otherwise it is
/// integrated. Bitwise equal for any number of threads. Throws InputError for fewer than 2 rays for a patch.
GoniophotometerMeasurement measure_fluorescence_f(const Fluorescence& fluorescence, const Beam& beam,
                                                  const DetectorSphere& sphere, int64_t rays, uint64_t seed,
                                                  const ThreadPool& pool);

}  // namespace frond
