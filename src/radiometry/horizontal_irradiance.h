#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/light.h"
#include "core/wavelengths.h"

namespace frond {

/// Spectral irradiance of a horizontal plane that faces +z above a scene, under its distant lights: what a BRF or an
/// absorbed share is measured by. In the units of the lights' radiance, times sr.
class HorizontalIrradiance {
 public:
  /// Wide lights are summed up over kDirections of them, the same on every machine. Throws InputError where a light
  /// stands in the scene, or none shines from above at some wavelength of the strategy.
  HorizontalIrradiance(std::span<const Light* const> lights, const WavelengthStrategy& wavelengths);

  SampledSpectrum at(const SampledWavelengths& lambda) const;
  /// What part of it each light gives, on average over the wavelengths.
  const std::vector<double>& shares() const { return shares_; }
  /// What a sensor's bands say of it.
  const std::vector<double>& bands() const { return bands_; }

 private:
  static constexpr int kDirections = 1 << 16;

  double at(double nm) const;
  void sum_bands(const WavelengthStrategy& wavelengths);

  std::vector<double> nm_, values_;
  std::vector<double> shares_, bands_;
};

/// Direction toward the scene's only light of one direction, as far as it stands above the horizon; empty where there
/// is none, or more than one.
std::optional<Vec3> direction_to_sun(std::span<const Light* const> lights);

}  // namespace frond
