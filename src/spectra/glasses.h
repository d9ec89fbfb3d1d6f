#pragma once

#include "core/spectrum.h"

namespace frond {

/// Coefficients of Sellmeier's equation: n^2 = 1 + sum of b l^2 / (l^2 - c), with the wavelength l in micrometres.
struct Sellmeier {
  std::array<double, 3> b, c_um2;
};

/// Index of refraction of a glass by Sellmeier's equation, 300 to 2500 nm.
class GlassSpectrum final : public Spectrum {
 public:
  explicit GlassSpectrum(const Sellmeier& s) : s_(s) {}
  float at(float lambda_nm) const override;
  Interval range_nm() const override { return kRange_nm; }
  float max_value() const override { return at(float(kRange_nm.min)); }  // n decreases with wavelength

 private:
  static constexpr Interval kRange_nm{300, 2500};
  Sellmeier s_;
};

// Indices of refraction of SCHOTT's glasses. The coefficients are from SCHOTT's data sheets, by way of
// refractiveindex.info. They agree within 5e-4 with pbrt-v4's tables, which begin at 300 to 400 nm and end near 910 nm.
SpectrumPtr glass_bk7();    ///< N-BK7
SpectrumPtr glass_baf10();  ///< N-BAF10
SpectrumPtr glass_fk51a();  ///< N-FK51A
SpectrumPtr glass_lasf9();  ///< N-LASF9
SpectrumPtr glass_sf5();    ///< N-SF5
SpectrumPtr glass_sf10();   ///< N-SF10
SpectrumPtr glass_sf11();   ///< N-SF11

}  // namespace frond
