#include "spectra/glasses.h"

namespace frond {
namespace {

SpectrumPtr glass(const Sellmeier& s) { return std::make_shared<GlassSpectrum>(s); }

}  // namespace

float GlassSpectrum::at(float lambda_nm) const {
  const double um = std::clamp(double(lambda_nm), kRange_nm.min, kRange_nm.max) * 1e-3, square = um * um;
  double n2 = 1;
  for (size_t i = 0; i < s_.b.size(); ++i) n2 += s_.b[i] * square / (square - s_.c_um2[i]);
  return static_cast<float>(std::sqrt(n2));
}

SpectrumPtr glass_bk7() {
  static const SpectrumPtr spectrum =
      glass({{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}});
  return spectrum;
}

SpectrumPtr glass_baf10() {
  static const SpectrumPtr spectrum =
      glass({{1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}});
  return spectrum;
}

SpectrumPtr glass_fk51a() {
  static const SpectrumPtr spectrum =
      glass({{0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}});
  return spectrum;
}

SpectrumPtr glass_lasf9() {
  static const SpectrumPtr spectrum =
      glass({{2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}});
  return spectrum;
}

SpectrumPtr glass_sf5() {
  static const SpectrumPtr spectrum =
      glass({{1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}});
  return spectrum;
}

SpectrumPtr glass_sf10() {
  static const SpectrumPtr spectrum =
      glass({{1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}});
  return spectrum;
}

SpectrumPtr glass_sf11() {
  static const SpectrumPtr spectrum =
      glass({{1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}});
  return spectrum;
}

}  // namespace frond
