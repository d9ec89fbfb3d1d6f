#include <bit>
#include <cmath>
#include <optional>

#include "core/fluorescence.h"
#include "core/wavelengths.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/color/film_sensor.h"
#include "spectra/wavelengths/registry.h"

namespace frond {
namespace {

constexpr Param kMin{.name = "lambdamin",
                     .kind = ParamKind::real,
                     .default_value = 360.0,
                     .unit = "nm",
                     .range = kWavelengthRange_nm,
                     .doc = "Shortest wavelength."};
constexpr Param kMax{.name = "lambdamax",
                     .kind = ParamKind::real,
                     .default_value = 830.0,
                     .unit = "nm",
                     .range = kWavelengthRange_nm,
                     .doc = "Longest wavelength; the film sees none beyond 830 nm."};
constexpr Param kSensor{.name = "sensor",
                        .kind = ParamKind::string,
                        .default_value = kFilmSensors[0],
                        .doc = "Sensor of the film; the scene's Film can set it too.",
                        .choices = kFilmSensors};
constexpr Param kWhiteBalance{.name = "whitebalance",
                              .kind = ParamKind::real,
                              .default_value = 0.0,
                              .unit = "K",
                              .range = {0, 1e5},
                              .doc =
                                  "Colour temperature of the daylight that is rendered as white; 0: 6500 K for camera "
                                  "sensors, no adaptation for cie1931. The scene's Film can set it too."};
constexpr Param kFluorescence{.name = "fluorescence",
                              .kind = ParamKind::boolean,
                              .default_value = false,
                              .doc =
                                  "Add the fluorescence of leaves to the light that they reflect "
                                  "(docs/fluorescence.md); the wavelengths must reach from 400 to 750 nm."};
constexpr Param kUniform{.name = "uniform",
                         .kind = ParamKind::boolean,
                         .default_value = false,
                         .doc = "Sample all wavelengths with the same density; the scene's Film \"spectral\" sets it."};
constexpr Param kHeroParams[] = {kMin, kMax, kSensor, kWhiteBalance, kFluorescence, kUniform};

/// Density of wavelengths: uniform, or proportional to 1 / cosh^2(0.0072 (nm - 538)), close to the eye's response
/// (Radziszewski et al. 2009); over 360 to 830 nm the constant factor is then 0.0039398042. Its integral is a
/// difference of tanh, which is inverted.
class WavelengthDensity {
 public:
  WavelengthDensity(Interval nm, bool is_uniform)
      : range_nm_(nm),
        tanh_min_(std::tanh(reduced(nm.min))),
        tanh_max_(std::tanh(reduced(nm.max))),
        is_uniform_(is_uniform) {}

  struct Sample {
    double nm, pdf;
  };
  Sample sample(double u) const {
    if (is_uniform_) return {std::lerp(range_nm_.min, range_nm_.max, u), 1 / (range_nm_.max - range_nm_.min)};
    const double t = std::lerp(tanh_min_, tanh_max_, u);
    const double atanh_t = std::log((1 + t) / (1 - t)) / 2;
    return {std::clamp(kPeak_nm + atanh_t / kRate, range_nm_.min, range_nm_.max),
            kRate * (1 - t * t) / (tanh_max_ - tanh_min_)};
  }
  Interval range_nm() const { return range_nm_; }

 private:
  static constexpr double kRate = 0.0072, kPeak_nm = 538;  // 1/nm, nm
  static double reduced(double nm) { return kRate * (nm - kPeak_nm); }

  Interval range_nm_;
  double tanh_min_, tanh_max_;
  bool is_uniform_;
};

Interval range_of(const Params& p) {
  const Interval nm{p.real("lambdamin"), p.real("lambdamax")};
  if (nm.min >= nm.max)
    fail(p.where("lambdamax"), "\"lambdamax\" is {} nm, above \"lambdamin\", {} nm, is needed", nm.max, nm.min);
  return nm;
}

/// Returns the film's sensor; nothing for the CIE 1931 observer without white balance, which needs no table.
std::optional<FilmSensor> sensor_of(const Params& p) {
  constexpr double kColdest_kelvin = 1000;
  const std::string name = p.string("sensor");
  const double white_kelvin = p.real("whitebalance");
  if (white_kelvin > 0 && white_kelvin < kColdest_kelvin)
    fail(p.where("whitebalance"), "\"whitebalance\" is {} K: 0, or {} K at least, is needed", white_kelvin,
         kColdest_kelvin);
  if (name == kFilmSensors[0] && white_kelvin == 0) return {};
  return FilmSensor(name, white_kelvin);
}

/// Quarter of the spectrum in which the first lane of a path with the number u lies: the sum of the digits of u in base
/// 4, modulo 4. n = 2^k paths whose u are n equal steps apart then have first lanes in n equal intervals as well. Given
/// the wavelengths, the last digits of u, which are random, decide which of them is the first.
uint32_t first_quarter(float u) {
  constexpr uint32_t kLowDigitBits = 0x55555555;
  const auto digits = static_cast<uint32_t>(static_cast<uint64_t>(double(u) * 0x1p32));
  return uint32_t(std::popcount(digits & kLowDigitBits) + 2 * std::popcount(digits & ~kLowDigitBits)) % kLanes;
}

/// Hero wavelength spectral sampling (Wilkie et al. 2014): four wavelengths at equal steps of the density's integral.
/// Their places in the quarters of the spectrum are u, so that n paths whose u are in n equal intervals have 4n
/// wavelengths in 4n equal intervals. The film's channels are CIE XYZ.
class Hero final : public WavelengthStrategy, public FluorescenceColors {
 public:
  explicit Hero(const Params& p)
      : density_(range_of(p), p.boolean("uniform")),
        film_(sensor_of(p)),
        adds_fluorescence_(p.boolean("fluorescence")) {
    const Interval nm = density_.range_nm();
    if (adds_fluorescence_ && !(nm.contains(kExcitation_nm.min) && nm.contains(kExcitation_nm.max)))
      fail(p.where("fluorescence"), "fluorescence is excited from {} to {} nm, the wavelengths reach from {} to {} nm",
           kExcitation_nm.min, kExcitation_nm.max, nm.min, nm.max);
  }

  SampledWavelengths sample(float u) const override {
    const uint32_t first = first_quarter(u);
    SampledWavelengths lambda;
    lambda.count = kLanes;
    for (size_t i = 0; i < kLanes; ++i) {
      const auto [nm, pdf] = density_.sample((double((first + i) % kLanes) + double(u)) / kLanes);
      lambda.nm[i] = static_cast<float>(nm);
      lambda.pdf[i] = static_cast<float>(pdf);
      lambda.active[i] = true;
    }
    return lambda;
  }
  /// The first lane has the stratification of the sampler, which a lane drawn by a BSDF would lose.
  SampledWavelengths sample_for_index(uint64_t, float u) const override {
    SampledWavelengths lambda = sample(u);
    lambda.hero = 0;
    return lambda;
  }
  Interval range_nm() const override { return density_.range_nm(); }
  std::span<const float> fixed_nm() const override { return {}; }
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const override {
    Triple xyz{};
    for (size_t i = 0; i < kLanes; ++i) {
      const Triple bar = film_ ? film_->at(double(lambda.nm[i])) : cie_xyz(double(lambda.nm[i]));
      const double weight = double(radiance.v[i]) / (double(lambda.pdf[i]) * lambda.count);
      for (size_t c = 0; c < 3; ++c) xyz[c] += bar[c] * weight;
    }
    return xyz;
  }
  std::string_view film_space() const override { return kXyzName; }
  bool adds_fluorescence() const override { return adds_fluorescence_; }

 private:
  WavelengthDensity density_;
  std::optional<FilmSensor> film_;
  bool adds_fluorescence_;
};

}  // namespace

extern const WavelengthsInfo hero_wavelengths{
    {"wavelengths", "hero",
     "Four stratified wavelengths per path from the full spectrum, sampled by the eye's sensitivity.",
     "Wilkie et al. 2014; density after Radziszewski et al. 2009", kHeroParams},
    [](const Params& p) -> std::unique_ptr<WavelengthStrategy> { return std::make_unique<Hero>(p); }};

}  // namespace frond
