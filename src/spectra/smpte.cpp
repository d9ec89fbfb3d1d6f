#include "spectra/cie.h"
#include "spectra/registry.h"

namespace frond {
namespace {

constexpr std::array<float, 3> kLambda_nm{608, 551, 455};

/// A channel is the radiance at one wavelength over that of the reference white, D65 of luminance 1: white under D65 is
/// white. The channels are then those of linear SMPTE-C, to the accuracy of three wavelengths.
class Smpte final : public WavelengthStrategy {
 public:
  explicit Smpte(const Params&) {
    for (size_t i = 0; i < 3; ++i) per_radiance_[i] = 1 / double(unit_d65()->at(kLambda_nm[i]));
  }
  SampledWavelengths sample(float) const override {
    SampledWavelengths lambda;
    for (size_t i = 0; i < 3; ++i) lambda.nm[i] = kLambda_nm[i], lambda.pdf[i] = 1, lambda.active[i] = true;
    lambda.count = 3;
    return lambda;
  }
  Interval range_nm() const override { return {double(kLambda_nm[2]), double(kLambda_nm[0])}; }
  std::span<const float> fixed_nm() const override { return kLambda_nm; }
  Triple sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override {
    Triple rgb;
    for (size_t i = 0; i < 3; ++i) rgb[i] = double(radiance.v[i]) * per_radiance_[i];
    return rgb;
  }
  std::string_view film_space() const override { return "linear SMPTE-C"; }

 private:
  Triple per_radiance_;
};

}  // namespace

extern const WavelengthsInfo smpte_wavelengths{
    {"wavelengths",
     "smpte",
     "608, 551 and 455 nm, one for each channel of linear SMPTE-C.",
     "Baranoski and Rokne: dominant wavelengths of the SMPTE-C primaries (by CIE 1931 data the blue one is 464.7 nm)",
     {}},
    [](const Params& p) -> std::unique_ptr<WavelengthStrategy> { return std::make_unique<Smpte>(p); }};

}  // namespace frond
