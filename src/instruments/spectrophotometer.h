#pragma once

#include "instruments/errors/statistics.h"
#include "instruments/rays.h"

namespace frond {

/// How long a measurement goes on.
struct Dose {
  int64_t rays = 1'000'000;   ///< at most
  double standard_error = 0;  ///< above 0: ends as soon as those of R, T and A are no larger
};

/// Shares of the light on a specimen, each with its standard error.
struct SpectrophotometerMeasurement {
  Beam beam;
  int64_t rays = 0;
  bool tells_surface = false;   ///< whether the material's flags tell Rs and Rd apart
  Estimate surface = {};        ///< Rs: leaves at its first event, on the lit side
  Estimate subsurface = {};     ///< Rd: comes back out of the body, on the lit side
  Estimate reflectance = {};    ///< R = Rs + Rd
  Estimate transmittance = {};  ///< T: leaves by the other side
  Estimate absorptance = {};    ///< A = 1 - R - T; its error is that of the sum, not of independent parts

  /// The largest standard error of R, T and A.
  double standard_error() const;
};

/// Measures with an integrating sphere on each side: light comes in along the direction that the material's model calls
/// incident, and each ray's weight counts by the side and the lobe that it leaves by. Deterministic: depends on the
/// lit and the number of rays alone. With a standard error asked for, rays are shot in rounds, each as long as the
/// error so far says, the first long enough (2 / standard error) that an outcome it never met cannot hide a larger one.
/// Throws InputError for fewer than 2 rays, a beam out of range, and weights that are not numbers.
SpectrophotometerMeasurement measure_shares(const LitMaterial& lit, const Dose& dose, const ThreadPool& pool,
                                            const RayProgress& progress = {});

}  // namespace frond
