#include "spectra/analytic.h"

namespace frond {
namespace {

// Exact values by the definition of the SI (2019): c2 = h c / k and, from it, Wien's displacement constant.
constexpr double kSecondRadiation_nm_K = 1.438776877e7;
constexpr double kWien_nm_K = 2.897771955e6;

/// Returns the spectral radiance of a blackbody up to a constant factor (Planck 1901).
double planck(double lambda_nm, double kelvin) {
  const double l = lambda_nm / 1000;
  return 1 / (l * l * l * l * l * std::expm1(kSecondRadiation_nm_K / (lambda_nm * kelvin)));
}

}  // namespace

BlackbodySpectrum::BlackbodySpectrum(double kelvin, const Location& where) : kelvin_(kelvin) {
  if (!Interval{100, 1e6}.contains(kelvin))
    fail(where, "a blackbody's temperature is {} K, outside its range 100 to 1000000 K", kelvin);
  scale_ = 1 / planck(kWien_nm_K / kelvin, kelvin);
}

float BlackbodySpectrum::at(float lambda_nm) const {
  return static_cast<float>(scale_ * planck(double(lambda_nm), kelvin_));
}

}  // namespace frond
