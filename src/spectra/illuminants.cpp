#include "spectra/illuminants.h"

#include "spectra/analytic.h"
#include "spectra/daylight.h"

namespace frond {
namespace {

/// CIE illuminant A: Planck's law at 2848 K with the constant c2 = 1.435e-2 m K of 1931, which is a blackbody of about
/// 2855.5 K with the present constant. Defined from 300 to 830 nm (CIE S 014-2:2006, Colorimetry, part 2; CIE 15:2004,
/// 3.1).
class IlluminantA final : public Spectrum {
 public:
  float at(float lambda_nm) const override {
    const double l = std::clamp(double(lambda_nm), kRange_nm.min, kRange_nm.max);
    return static_cast<float>(kAtMiddle * std::pow(kMiddle_nm / l, 5) * planck(kMiddle_nm) / planck(l));
  }
  Interval range_nm() const override { return kRange_nm; }
  float max_value() const override { return at(float(kRange_nm.max)); }  // the spectrum increases up to 1015 nm

 private:
  static constexpr Interval kRange_nm{300, 830};
  static constexpr double kAtMiddle = 100, kMiddle_nm = 560;

  static double planck(double lambda_nm) { return std::expm1(1.435e7 / (2848 * lambda_nm)); }
};

/// Daylight illuminant of a nominal temperature, such as 5000 K for D50, which is one on the scale of 1931.
SpectrumPtr standard_daylight(double kelvin) {
  return cie_daylight(kelvin_by_scale_of_1931(kelvin), DaylightDigits::three);
}

}  // namespace

SpectrumPtr d50() {
  static const SpectrumPtr spectrum = standard_daylight(5000);
  return spectrum;
}

SpectrumPtr d55() {
  static const SpectrumPtr spectrum = standard_daylight(5500);
  return spectrum;
}

SpectrumPtr d75() {
  static const SpectrumPtr spectrum = standard_daylight(7500);
  return spectrum;
}

SpectrumPtr aces_d60() {
  static const SpectrumPtr spectrum = cie_daylight(6000, DaylightDigits::three);
  return spectrum;
}

SpectrumPtr illuminant_a() {
  static const SpectrumPtr spectrum = std::make_shared<IlluminantA>();
  return spectrum;
}

SpectrumPtr illuminant_e() {
  static const SpectrumPtr spectrum = std::make_shared<ConstantSpectrum>(100.f, Interval{300, 2500});
  return spectrum;
}

}  // namespace frond
