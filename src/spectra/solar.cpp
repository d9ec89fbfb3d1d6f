#include "spectra/solar.h"

#include <vector>

#include "spectra/csv_columns.h"
#include "spectra/data_files.h"
#include "spectra/tabulated.h"

namespace frond {
namespace {

/// Returns a column of solar.csv as a spectrum over the wavelengths in column 0.
SpectrumPtr column(size_t index) {
  const auto columns = csv_columns(solar_csv);  // wavelength_nm, extraterrestrial, global, direct
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < columns[0].size(); ++i) points.push_back({columns[0][i], columns[index][i]});
  return make_tabulated(points);
}

}  // namespace

SpectrumPtr solar_am0() {
  static const SpectrumPtr spectrum = column(1);
  return spectrum;
}

SpectrumPtr solar_am15_global() {
  static const SpectrumPtr spectrum = column(2);
  return spectrum;
}

SpectrumPtr solar_am15_direct() {
  static const SpectrumPtr spectrum = column(3);
  return spectrum;
}

}  // namespace frond
