#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/light.h"
#include "core/wavelengths.h"
#include "render/session.h"

namespace frond {

/// Spectral irradiance of a horizontal plane that faces +z above a scene, under its distant lights: the reference of a
/// BRF or an absorbed share. Unit: unit of the lights' radiance, times sr.
class HorizontalIrradiance {
 public:
  /// Extended lights are integrated with 65,536 directions, the same on every machine. Throws InputError for a light at
  /// a finite distance, or if no light comes from above in a band of the scene.
  explicit HorizontalIrradiance(const LoadedScene& loaded);

  /// Returns the irradiance at up to kLanes wavelengths.
  SampledSpectrum at(const SampledWavelengths& lambda) const;
  /// Returns each light's share of the irradiance, averaged over the wavelengths that have light.
  const std::vector<double>& shares() const { return shares_; }
  /// Returns the irradiance in each band of the scene: of a band with a response, the mean under it.
  const std::vector<double>& bands() const { return bands_; }
  /// Returns the irradiance over the wavelengths of all bands, linear between points; nullptr if the bands are single
  /// wavelengths.
  const SpectrumPtr& spectrum() const { return spectrum_; }

 private:
  double at(double nm) const;

  std::vector<double> nm_, values_;
  std::vector<double> shares_, bands_;
  SpectrumPtr spectrum_;
};

/// Returns the irradiance between two wavelengths as a spectrum with all points of the lights' own tables.
SpectrumPtr horizontal_irradiance(const Scene& scene, Interval nm);

/// Returns the direction toward the scene's only directional light or sun (Light::sun), if it is above the horizon;
/// nullopt if there is none or more than one.
std::optional<Vec3> direction_to_sun(std::span<const Light* const> lights);

}  // namespace frond
