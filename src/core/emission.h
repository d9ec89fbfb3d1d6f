#pragma once

#include <optional>

#include "core/light.h"

namespace frond {

/// Ray that leaves a light at a finite position.
struct EmittedRay {
  Vec3 origin, direction;  ///< world space; the direction is a unit vector
  SampledSpectrum power;   ///< spectral power, W/nm if radiance is in W/(m^2 sr nm); its mean is that of the light
};

/// Light whose rays can be sampled where they leave it: a lamp in the scene.
class EmissionSampler {
 public:
  virtual ~EmissionSampler() = default;
  /// Samples a point and a direction for uniform numbers in [0, 1)^2; empty if no light leaves the light there.
  virtual std::optional<EmittedRay> sample_emission(Vec2 point, Vec2 direction,
                                                    const SampledWavelengths& lambda) const = 0;
};

}  // namespace frond
