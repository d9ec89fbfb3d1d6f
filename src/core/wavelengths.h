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

/// What one path tells the film: values of some of its channels. Channels that are not named learn nothing.
struct SensorResponse {
  std::array<double, kLanes> value{};
  std::array<uint16_t, kLanes> channel{0, 1, 2, 3};
  int count = 0;

  SensorResponse() = default;
  /// Of a film of three colours.
  SensorResponse(const std::array<double, 3>& color)  // NOLINT(google-explicit-constructor): a response as it is
      : value{color[0], color[1], color[2], 0}, count(3) {}
  double operator[](size_t i) const { return value[i]; }
  std::array<double, 3> color() const { return {value[0], value[1], value[2]}; }
};

/// Of a sensor's response, in whatever unit.
struct ResponsePoint {
  double nm, value;
  friend bool operator==(const ResponsePoint&, const ResponsePoint&) = default;
};

/// A film channel that is no colour: the radiance at one wavelength, or its mean under a response.
struct Band {
  double nm;                                 ///< the wavelength, or the response's centre of gravity
  std::vector<ResponsePoint> response = {};  ///< linear between the points, 0 beyond; empty: the wavelength alone
};

/// How the wavelengths of a path are chosen, and what film channels its radiance feeds.
class WavelengthStrategy {
 public:
  virtual ~WavelengthStrategy() = default;
  /// Wavelengths of one path from a uniform u in [0, 1).
  virtual SampledWavelengths sample(float u) const = 0;
  /// The same for sample `index` of a pixel. A strategy with more bands than a path has lanes deals them out in turn,
  /// so that any run of samples has its share of each.
  virtual SampledWavelengths sample_in_turn([[maybe_unused]] uint64_t index, float u) const { return sample(u); }
  /// Everything `sample` can return lies in here (nm).
  virtual Interval range_nm() const = 0;
  /// The wavelengths (nm) where every path carries the same ones, and `sample` always returns the same; empty where
  /// they vary.
  virtual std::span<const float> fixed_nm() const = 0;
  /// All wavelengths (nm) that paths can carry, ascending, where they are so many and no more; empty where they are any
  /// of a range.
  virtual std::span<const float> listed_nm() const { return {}; }
  /// What one path of this radiance says of film channels: an unbiased estimate of the sensor's response in each that
  /// it names.
  virtual SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const = 0;
  /// Colour space of the film's three channels, a name of spectra/color/color_space.h: "XYZ" or "linear SMPTE-C"; empty
  /// where the channels are bands.
  virtual std::string_view film_space() const = 0;
  /// Shares of the lanes in luminance where they are red, green and blue, as many as lanes; empty elsewhere.
  virtual std::span<const float> luminance_shares() const { return {}; }
  /// The film's channels, in order, where they are no colours.
  virtual std::span<const Band> bands() const { return {}; }
};

struct WavelengthsInfo : PluginInfo {
  std::unique_ptr<WavelengthStrategy> (*make)(const Params&);
};

}  // namespace frond
