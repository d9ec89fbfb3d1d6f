#pragma once

#include <optional>
#include <span>
#include <vector>

#include "radiometry/horizontal_irradiance.h"

namespace frond {

/// Samples the light that enters a scene from its sun and sky, in proportion to the irradiance on a horizontal plane.
class IncidentLight {
 public:
  /// `lambda`: wavelengths at which the scene has light.
  IncidentLight(const Scene& scene, HorizontalIrradiance irradiance, const SampledWavelengths& lambda);

  struct Sample {
    Vec3 direction;          ///< direction of propagation, downward
    SampledSpectrum weight;  ///< mean 1
    bool is_direct = false;  ///< as frond::is_direct
  };
  /// Returns a direction of one of the lights; nullopt if the sample fails.
  std::optional<Sample> sample(RandomStream& random, const SampledWavelengths& lambda) const;

 private:
  std::span<const Light* const> lights_;
  std::vector<const EnvironmentLight*> cosine_sampled_;  ///< by light; nullptr: the light samples itself
  HorizontalIrradiance irradiance_;
};

}  // namespace frond
