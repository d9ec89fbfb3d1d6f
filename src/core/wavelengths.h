#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/plugin.h"
#include "core/spectrum.h"

namespace frond {

/// How the wavelengths of a path are chosen, and what film channels its radiance feeds.
class WavelengthStrategy {
 public:
  virtual ~WavelengthStrategy() = default;
  /// Wavelengths of one path from a uniform u in [0, 1).
  virtual SampledWavelengths sample(float u) const = 0;
  /// Everything `sample` can return lies in here (nm).
  virtual Interval range_nm() const = 0;
  /// The wavelengths (nm) where every path carries the same ones; empty where they vary.
  virtual std::span<const float> fixed_nm() const = 0;
  /// What one path of this radiance adds to the three film channels: an unbiased estimate of the sensor's response.
  virtual std::array<double, 3> sensor(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const = 0;
  /// Colour space of those channels, a name of spectra/color_space.h: "XYZ" or "linear SMPTE-C".
  virtual std::string_view film_space() const = 0;
};

struct WavelengthsInfo : PluginInfo {
  std::unique_ptr<WavelengthStrategy> (*make)(const Params&);
};

}  // namespace frond
