#pragma once

#include "instruments/errors/statistics.h"
#include "instruments/rays.h"

namespace frond {

/// When a measurement ends.
struct RayBudget {
  int64_t rays = 1'000'000;   ///< at most
  double standard_error = 0;  ///< above 0: end when the standard errors of R, T and A are at most this
};

/// Result of a spectrophotometer: shares of the incident light, each with its standard error.
struct SpectrophotometerMeasurement {
  Beam beam;
  int64_t rays = 0;
  bool distinguishes_surface = false;  ///< whether the material's flags distinguish Rs and Rd
  Estimate surface = {};               ///< Rs: leaves at its first event, on the lit side
  Estimate subsurface = {};            ///< Rd: reflected after it was inside the leaf, on the lit side
  Estimate reflectance = {};           ///< R = Rs + Rd
  Estimate transmittance = {};         ///< T: leaves by the other side
  Estimate absorptance = {};           ///< A = 1 - R - T; its error is the error of R + T

  /// The largest standard error of R, T and A.
  double standard_error() const;
};

/// Measures with an integrating sphere on each side: light comes in along the incident direction of the material's
/// model, and each ray's weight counts by its side and lobe. Deterministic: depends on `lit` and the number of rays
/// alone. If a standard error is requested, rays are traced in rounds whose length follows from the error so far; the
/// first has at least 2 / standard error rays, so that an outcome that has not occurred cannot hide a larger error.
/// Throws InputError for fewer than 2 rays, a beam out of range, and weights that are not numbers.
SpectrophotometerMeasurement measure_shares(const LitMaterial& lit, const RayBudget& budget, const ThreadPool& pool,
                                            const RayProgress& progress = {});

}  // namespace frond
