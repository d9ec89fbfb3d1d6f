#pragma once

#include "core/material.h"
#include "core/parallel.h"
#include "instruments/errors/statistics.h"

namespace frond {

/// A flat specimen as a path meets it. `material` is prepared for the wavelengths, which are the same for every path.
struct PathHit {
  const Material& material;
  SampledWavelengths lambda;
  double theta_deg;  ///< from the front's normal to where the path came from (wo), 0 to 180 and not 90
  uint64_t seed = 0;
};

/// A one-sample estimate: means over the wavelengths of its expectation and of its variance, each with the error of
/// having been found out by some samples.
struct Worth {
  Estimate mean, variance;
};

/// What a sample of a BSDF is worth: how much one-sample estimates of three things differ from each other.
struct SampleWorth {
  /// Of the albedo for light from everywhere, by one scattered ray: f |cos theta| / pdf.
  Worth albedo;
  /// Of the radiance under a sky above the front, where a white diffuse surface has 1. Light sample and scattered ray
  /// together, as the path integrator weighs them (power heuristic). The sky is the overcast one of the CIE, 1 + 2 cos
  /// theta (Moon and Spencer 1942), drawn in proportion to its radiance.
  Worth sky;
  /// The same under the sun's disc, 0.533 degrees wide, 45 degrees from the front's normal, across the plane of sight.
  Worth sun;
};

inline constexpr double kSunZenith_deg = 45, kSunRadius_deg = 0.2665;

/// Deterministic: depends on the hit and the number of samples alone, which is rounded up to a multiple of 64. Throws
/// InputError for angles out of range, a material that says it has no surface there, and weights that are no numbers.
SampleWorth measure_worth(const PathHit& hit, int64_t samples, const ThreadPool& pool);

}  // namespace frond
