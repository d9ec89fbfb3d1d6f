#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/plugin.h"
#include "core/spectrum.h"

namespace frond {

/// Wavelengths (nm) that a render or a measurement can have.
inline constexpr Interval kWavelengthRange_nm{300, 2500};

/// Values that one path contributes to some of the film's channels. Channels that are not listed receive no sample.
struct SensorResponse {
  std::array<double, kLanes> value{};
  std::array<uint16_t, kLanes> channel{0, 1, 2, 3};
  int count = 0;

  SensorResponse() = default;
  /// Response of a film with three colour channels.
  SensorResponse(const std::array<double, 3>& color)  // NOLINT(google-explicit-constructor): a colour is a response
      : value{color[0], color[1], color[2], 0}, count(3) {}
  double operator[](size_t i) const { return value[i]; }
  std::array<double, 3> color() const { return {value[0], value[1], value[2]}; }
};

/// Point of a sensor's spectral response curve; `value` has any unit.
struct ResponsePoint {
  double nm, value;
  friend bool operator==(const ResponsePoint&, const ResponsePoint&) = default;
};

/// Spectral band, as a channel of the film: the radiance at one wavelength, or its mean weighted by a response curve.
struct Band {
  double nm;                                 ///< wavelength, or centroid of the response
  std::vector<ResponsePoint> response = {};  ///< linear between the points, 0 beyond; empty: the single wavelength
  std::string name = {};                     ///< of a band with a response or of fluorescence, unique; else empty
};

/// Wavelength strategy: samples the wavelengths of a path and converts its radiance to values of film channels.
/// Thread-safe.
class WavelengthStrategy {
 public:
  virtual ~WavelengthStrategy() = default;
  /// Wavelengths of one path for a uniform u in [0, 1).
  virtual SampledWavelengths sample(float u) const = 0;
  /// Wavelengths of sample `index` of a pixel. Sets SampledWavelengths::hero if that lane alone has the distribution of
  /// `sample`. A strategy with more bands than a path has lanes assigns them in turn: consecutive samples cover all
  /// bands evenly.
  virtual SampledWavelengths sample_for_index([[maybe_unused]] uint64_t index, float u) const { return sample(u); }
  /// Interval that contains all wavelengths that `sample` can return (nm).
  virtual Interval range_nm() const = 0;
  /// Wavelengths (nm) of a strategy whose paths all carry the same ones; empty if they vary from path to path.
  virtual std::span<const float> fixed_nm() const = 0;
  /// All wavelengths (nm) that paths can carry, ascending, if they are a finite set; empty if they are continuous.
  virtual std::span<const float> listed_nm() const { return {}; }
  /// Converts the radiance of one path to film values: an unbiased estimate of the sensor's response in each channel
  /// that the result lists.
  virtual SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const = 0;
  /// Colour space of the film's three channels, `XYZ` or `linear SMPTE-C` (spectra/color/color_space.h); empty if the
  /// channels are bands.
  virtual std::string_view film_space() const = 0;
  /// Luminance weights of the lanes if these are red, green and blue, one for each lane; else empty.
  virtual std::span<const float> luminance_shares() const { return {}; }
  /// The film's channels if they are spectral bands, in the order in which the user named them; empty if they are
  /// colours.
  virtual std::span<const Band> bands() const { return {}; }
};

/// Plug-in record of a wavelength strategy.
struct WavelengthsInfo : PluginInfo {
  /// Returns a strategy, not null. Throws InputError.
  std::unique_ptr<WavelengthStrategy> (*make)(const Params&);
};

}  // namespace frond
