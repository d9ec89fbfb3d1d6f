#pragma once

#include "core/material.h"
#include "core/parallel.h"
#include "instruments/errors/statistics.h"

namespace frond {

/// A flat specimen as hit by a path. `material` is prepared for the wavelengths, which are the same for every path.
struct PathHit {
  const Material& material;
  SampledWavelengths lambda;
  double theta_deg;  ///< from the front's normal to where the path came from (wo), 0 to 180 and not 90
  uint64_t seed = 0;
};

/// Expectation and variance of a one-sample estimate, means over the wavelengths, each with its own sampling error.
struct Worth {
  Estimate mean, variance;
};

/// Variance of one-sample estimates of three integrals with a BSDF: a measure of its sampling.
struct SampleWorth {
  /// Albedo for light from everywhere, by one scattered ray: f |cos theta| / pdf.
  Worth albedo;
  /// Radiance under a sky above the front, where a white Lambertian surface has 1, by one light sample and one
  /// scattered ray, combined as in the path integrator (power heuristic). The sky is the overcast sky of the CIE, 1 + 2
  /// cos theta (Moon and Spencer 1942), sampled in proportion to its radiance.
  Worth sky;
  /// The same under the sun's disc, 0.533 degrees wide, 45 degrees from the front's normal, perpendicular to the plane
  /// of sight.
  Worth sun;
};

inline constexpr double kSunZenith_deg = 45, kSunRadius_deg = 0.2665;

/// Measures the three. Deterministic: depends on the hit and the number of samples alone, which is rounded up to a
/// multiple of 64. Throws InputError for angles out of range, a material without a surface there, and weights that are
/// not numbers.
SampleWorth measure_worth(const PathHit& hit, int64_t samples, const ThreadPool& pool);

}  // namespace frond
