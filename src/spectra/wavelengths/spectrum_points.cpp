#include "spectra/wavelengths/spectrum_points.h"

#include <algorithm>
#include <cmath>

#include "spectra/analytic.h"
#include "spectra/beyond_data.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/fixed_wavelengths.h"

namespace frond {

/// A DenseSpectrum has its points at whole nanometres; all other classes without a table are smooth.
void append_points_nm(const Spectrum& spectrum, std::vector<double>& nm) {
  if (const auto* table = dynamic_cast<const TabulatedSpectrum*>(&spectrum))
    nm.insert(nm.end(), table->lambda_nm().begin(), table->lambda_nm().end());
  else if (const auto* scaled = dynamic_cast<const ScaledSpectrum*>(&spectrum))
    append_points_nm(scaled->base(), nm);
  else if (const Spectrum* extended = base_of_extended(spectrum))
    append_points_nm(*extended, nm);
  else if (const Spectrum* known = base_of_precomputed(spectrum))
    append_points_nm(*known, nm);
}

void complete_points_nm(Interval range_nm, std::vector<double>& nm) {
  nm.insert(nm.end(), {range_nm.min, range_nm.max});
  for (double whole = std::ceil(range_nm.min); whole < range_nm.max; ++whole) nm.push_back(whole);
  std::erase_if(nm, [range_nm](double at) { return !range_nm.contains(at); });
  std::ranges::sort(nm);
  nm.erase(std::ranges::unique(nm).begin(), nm.end());
}

std::vector<double> points_nm(const Spectrum& spectrum, Interval range_nm) {
  std::vector<double> nm;
  append_points_nm(spectrum, nm);
  complete_points_nm(range_nm, nm);
  return nm;
}

}  // namespace frond
