#pragma once

#include "core/spectrum.h"

namespace frond {

/// Coefficients of Sellmeier's formula: n^2 = 1 + the sum of b l^2 / (l^2 - c), l the wavelength in micrometres.
struct Sellmeier {
  std::array<double, 3> b, c_um2;
};

/// Index of refraction of a glass from 300 to 2500 nm.
class GlassSpectrum final : public Spectrum {
 public:
  explicit GlassSpectrum(const Sellmeier& s) : s_(s) {}
  float at(float lambda_nm) const override;
  Interval range_nm() const override { return kRange_nm; }
  float max_value() const override { return at(float(kRange_nm.min)); }  // normal dispersion: it falls

 private:
  static constexpr Interval kRange_nm{300, 2500};
  Sellmeier s_;
};

// Coefficients of SCHOTT's data sheets, by way of refractiveindex.info. To 5e-4 the tables of pbrt-v4, which go from
// 300 to 400 nm on up to some 910 nm.
SpectrumPtr glass_bk7();    ///< N-BK7
SpectrumPtr glass_baf10();  ///< N-BAF10
SpectrumPtr glass_fk51a();  ///< N-FK51A
SpectrumPtr glass_lasf9();  ///< N-LASF9
SpectrumPtr glass_sf5();    ///< N-SF5
SpectrumPtr glass_sf10();   ///< N-SF10
SpectrumPtr glass_sf11();   ///< N-SF11

}  // namespace frond
