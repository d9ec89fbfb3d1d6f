#include <algorithm>

#include "spectra/cie.h"
#include "spectra/wavelengths/registry.h"

namespace frond {
namespace {

constexpr Param wavelength(std::string_view name, double nm, std::string_view doc) {
  return {.name = name, .kind = ParamKind::real, .default_value = nm, .unit = "nm", .range = kCieRange_nm, .doc = doc};
}
constexpr Param kSmpteParams[] = {
    wavelength("red", 608, "Wavelength of the red channel."),
    wavelength("green", 551, "Wavelength of the green channel."),
    wavelength(
        "blue", 455,
        "Wavelength of the blue channel, as published; by CIE 1931 data the blue primary's dominant wavelength is "
        "464.7 nm."),
};

/// Luminance of red, green and blue: Baranoski and Rokne, eq. 4, as printed.
constexpr std::array kLuminance{0.21222f, 0.7013f, 0.0865f};

/// A channel is the radiance at one wavelength divided by the radiance of the reference white, D65 of luminance 1, so
/// that a white surface under D65 is white. The channels approximate linear SMPTE-C, to the accuracy of three
/// wavelengths.
class Smpte final : public WavelengthStrategy {
 public:
  explicit Smpte(const Params& p)
      : nm_{static_cast<float>(p.real("red")), static_cast<float>(p.real("green")),
            static_cast<float>(p.real("blue"))} {
    if (nm_[0] == nm_[1] || nm_[1] == nm_[2] || nm_[2] == nm_[0])
      fail(p.where(), "red, green and blue are three different wavelengths: {:g}, {:g} and {:g} nm were given", nm_[0],
           nm_[1], nm_[2]);
    for (size_t i = 0; i < 3; ++i) per_radiance_[i] = 1 / double(unit_d65()->at(nm_[i]));
  }
  SampledWavelengths sample(float) const override {
    SampledWavelengths lambda;
    for (size_t i = 0; i < 3; ++i) lambda.nm[i] = nm_[i], lambda.pdf[i] = 1, lambda.active[i] = true;
    lambda.count = 3;
    return lambda;
  }
  Interval range_nm() const override {
    const auto [min, max] = std::minmax_element(nm_.begin(), nm_.end());
    return {double(*min), double(*max)};
  }
  std::span<const float> fixed_nm() const override { return nm_; }
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override {
    Triple rgb;
    for (size_t i = 0; i < 3; ++i) rgb[i] = double(radiance.v[i]) * per_radiance_[i];
    return rgb;
  }
  std::span<const float> luminance_shares() const override { return kLuminance; }
  std::string_view film_space() const override { return "linear SMPTE-C"; }

 private:
  std::array<float, 3> nm_;
  Triple per_radiance_;
};

}  // namespace

extern const WavelengthsInfo smpte_wavelengths{
    {"wavelengths", "smpte", "608, 551 and 455 nm, one for each channel of linear SMPTE-C.",
     "Baranoski and Rokne: dominant wavelengths of the SMPTE-C primaries", kSmpteParams},
    [](const Params& p) -> std::unique_ptr<WavelengthStrategy> { return std::make_unique<Smpte>(p); }};

}  // namespace frond
