#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "leaf/fit/fit.h"

namespace frond::leaf {

/// How a file of measured spectra is read.
struct SpectraMeasurement {
  std::string leaf = {};               ///< whose rows count, where the file has several leaves; empty: it has one
  double theta_deg = 8;                ///< of incidence, where no column says it
  std::string leaf_option = "--leaf";  ///< how messages name the choice of a leaf
};

/// A file of measured spectra.
struct MeasuredSpectra {
  std::vector<LeafMeasurement> measurements;
  size_t left_out = 0;         ///< rows beyond kConstantsRange_nm, or without a number
  bool is_in_percent = false;  ///< so that all was divided by 100
};

/// As instruments export it: rows of numbers between commas, semicolons, tabs or spaces, after lines of comment (#) and
/// one of names or none. Names, in any case and with a unit behind them or not: wavelength (nm, lambda, wvl), R
/// (reflectance, refl), T (transmittance, trans), theta_deg (angle), side (adaxial or upper, abaxial or lower), leaf
/// (material, sample); other columns are passed over. Without names: wavelength, R and, if there are three, T.
/// Wavelengths below 100 are in micrometres, values above 1.5 in percent. Decimals may have a comma where fields are
/// not separated by one. Throws InputError with `name`, line and column.
MeasuredSpectra parse_measured_spectra(std::string_view text, const std::string& name, const SpectraMeasurement& how);

/// The same of a file; InputError at `where` if it cannot be read.
MeasuredSpectra read_measured_spectra(const std::filesystem::path& path, const SpectraMeasurement& how);

}  // namespace frond::leaf
