#include "spectra/illuminants.h"

#include "spectra/analytic.h"
#include "spectra/named_tables.h"

namespace frond {
namespace {

/// CIE S 014-2:2006, Colorimetry, part 2; CIE 15:2004, 3.1: Planck's law at 2848 K with the constant c2 = 1.435e-2 m K
/// of 1931, which makes a blackbody of about 2855.5 K with today's. Defined from 300 to 830 nm.
class IlluminantA final : public Spectrum {
 public:
  float at(float lambda_nm) const override {
    const double l = std::clamp(double(lambda_nm), kRange_nm.min, kRange_nm.max);
    return static_cast<float>(kAtMiddle * std::pow(kMiddle_nm / l, 5) * planck(kMiddle_nm) / planck(l));
  }
  Interval range_nm() const override { return kRange_nm; }
  float max_value() const override { return at(float(kRange_nm.max)); }  // it rises up to 1015 nm

 private:
  static constexpr Interval kRange_nm{300, 830};
  static constexpr double kAtMiddle = 100, kMiddle_nm = 560;

  static double planck(double lambda_nm) { return std::expm1(1.435e7 / (2848 * lambda_nm)); }
};

/// Daylight of a correlated colour temperature from 4000 to 25000 K: its chromaticity, and by that the shares of the
/// components, to three places as the CIE has them.
SpectrumPtr daylight(double kelvin) {
  const double t = 1e3 / kelvin;
  const double x = kelvin <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                  : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  const double y = (-3 * x + 2.870) * x - 0.275;
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = std::round(1e3 * (-1.3515 - 1.7703 * x + 5.9114 * y) / m) / 1e3;
  const double m2 = std::round(1e3 * (0.0300 - 31.4424 * x + 30.0717 * y) / m) / 1e3;
  std::vector<SpectrumPoint> points = named_column("S0");
  const auto s1 = named_column("S1"), s2 = named_column("S2");
  for (size_t i = 0; i < points.size(); ++i) points[i].value += m1 * s1[i].value + m2 * s2[i].value;
  return make_tabulated(points);
}

/// Names are of temperatures by the constant c2 of 1931, 1.4380e-2 m K.
double by_scale_of_1931(double kelvin) { return kelvin * 1.4388 / 1.4380; }

}  // namespace

SpectrumPtr d50() {
  static const SpectrumPtr spectrum = daylight(by_scale_of_1931(5000));
  return spectrum;
}

SpectrumPtr d55() {
  static const SpectrumPtr spectrum = daylight(by_scale_of_1931(5500));
  return spectrum;
}

SpectrumPtr d75() {
  static const SpectrumPtr spectrum = daylight(by_scale_of_1931(7500));
  return spectrum;
}

SpectrumPtr aces_d60() {
  static const SpectrumPtr spectrum = daylight(6000);
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
