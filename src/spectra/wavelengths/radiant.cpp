#include "spectra/wavelengths/radiant.h"

#include <algorithm>
#include <cmath>

#include "spectra/wavelengths/spectrum_points.h"

namespace frond {
namespace {

/// Integral of the spectrum, or of the spectrum times the wavelength, between its points by Gauss's rule with two
/// points: exact for tables, and without values at the ends of a table, beyond which it is 0.
double integral(const Spectrum& spectrum, Interval range_nm, bool by_wavelength) {
  if (!(range_nm.min < range_nm.max)) return 0;
  const auto value = [&](double nm) { return double(spectrum.at(float(nm))) * (by_wavelength ? nm : 1); };
  const std::vector<double> nm = points_nm(spectrum, range_nm);
  double sum = 0;
  for (size_t i = 1; i < nm.size(); ++i) {
    const double middle = (nm[i - 1] + nm[i]) / 2, half = (nm[i] - nm[i - 1]) / 2, offset = half / std::sqrt(3.0);
    sum += (value(middle - offset) + value(middle + offset)) * half;
  }
  return sum;
}

}  // namespace

double radiant_integral(const Spectrum& spectrum) { return integral(spectrum, spectrum.range_nm(), false); }

double par_photons(const Spectrum& spectrum) {
  const Interval known = spectrum.range_nm();
  const Interval within{std::max(known.min, kPar_nm.min), std::min(known.max, kPar_nm.max)};
  return integral(spectrum, within, true) / kPhotonEnergy;
}

}  // namespace frond
