#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/light.h"
#include "core/wavelengths.h"
#include "render/session.h"

namespace frond {

/// Angle around the centre of a sun (Light::sun) within which light is direct, degrees: the sun's disc, whose radius is
/// at most 0.271 degrees, and next to nothing of the sky.
inline constexpr double kSunAngle_deg = 0.3;

/// Returns whether the light that arrives from `toward`, a unit vector toward the light, is direct: light of a single
/// direction, or from within kSunAngle_deg of a sun. Other distant light is diffuse, such as that of a sky or an image.
bool is_direct(const Light& light, const Vec3& toward);

/// Spectral irradiance of a horizontal plane that faces +z above a scene, under its distant lights: the reference of a
/// BRF or an absorbed share. Unit: unit of the lights' radiance, times sr.
class HorizontalIrradiance {
 public:
  /// Extended lights are integrated with 65,536 directions, the same on every machine. `range_nm`: to be known beyond
  /// the wavelengths of the scene's bands. With `target_area` lights may also be lamps in the scene (has_lamps): if
  /// there are any, spectral power takes the place of the irradiance, of distant lights that through the target. Throws
  /// InputError for another light at a finite distance, or whose data end within the range, or if no light comes from
  /// above in a band of the scene.
  explicit HorizontalIrradiance(const LoadedScene& loaded, const std::optional<Interval>& range_nm = {},
                                const std::optional<double>& target_area = {});

  /// Returns the irradiance at up to kLanes wavelengths.
  SampledSpectrum at(const SampledWavelengths& lambda) const;
  /// Returns each light's share of the irradiance, averaged over the wavelengths that have light.
  const std::vector<double>& shares() const { return shares_; }
  /// Returns the factor from the irradiance of a distant light: the area of the target with lamps, otherwise 1.
  double area() const { return area_; }
  /// Returns the irradiance in each band of the scene: of a band with a response, the mean under it.
  const std::vector<double>& bands() const { return bands_; }
  /// Returns the irradiance over the wavelengths of all bands, linear between points; nullptr if the bands are single
  /// wavelengths.
  const SpectrumPtr& spectrum() const { return spectrum_; }
  /// Same, of the direct light (is_direct).
  const SpectrumPtr& direct() const { return direct_; }

 private:
  double at(double nm) const;

  double area_ = 1;
  std::vector<double> nm_, values_;
  std::vector<double> shares_, bands_;
  SpectrumPtr spectrum_, direct_;
};

/// Returns whether a light is a lamp in the scene (EmissionSampler).
bool has_lamps(std::span<const Light* const> lights);

/// Returns the irradiance, or with lamps the spectral power of all lights, between two wavelengths as a spectrum with
/// all points of the lights' own tables. `target_area`: through which the light of distant lights enters.
SpectrumPtr horizontal_irradiance(const Scene& scene, Interval nm, const ThreadPool& pool, double target_area = 1);

/// Returns the direction toward the scene's only directional light or sun (Light::sun), if it is above the horizon;
/// nullopt if there is none or more than one.
std::optional<Vec3> direction_to_sun(std::span<const Light* const> lights);

}  // namespace frond
