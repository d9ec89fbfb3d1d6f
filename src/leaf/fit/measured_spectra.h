#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "leaf/fit/fit.h"

namespace frond::leaf {

/// Options of the reader of measured spectra.
struct SpectraMeasurement {
  std::string leaf = {};               ///< leaf to read from a file with several leaves; empty: the file has one
  double theta_deg = 8;                ///< angle of incidence if no column gives it
  std::string leaf_option = "--leaf";  ///< option that selects the leaf, for messages
  std::string all_option = {};         ///< option that reads all leaves, for messages; empty: there is none
};

/// Content of a file of measured spectra.
struct MeasuredSpectra {
  std::vector<LeafMeasurement> measurements;
  size_t left_out = 0;          ///< rows beyond kConstantsRange_nm, or without a number
  std::string in_percent = {};  ///< "R", "R and T", ...: what is in percent in the file; `measurements` are fractions
  char derived = 0;             ///< 'T' or 'R': follows from the other one and the absorptance; 0: none
  std::vector<std::string> unused = {};  ///< names of columns that are not read
  std::string layout = {};               ///< what was recognised and assumed, for the log; empty: a plain table
};

/// Reads text as instruments export it, in any layout that TextTable reads. Names of columns, in any case and with or
/// without a unit behind them: wavelength (nm, lambda, wvl), R (reflectance, refl), T (transmittance, trans), A
/// (absorptance), theta_deg (angle), side (adaxial or upper, abaxial or lower), leaf (material, sample); others are
/// listed as unused. If R or T has no column, it is 1 less the other one and A. Without names: wavelength, R and, if
/// there are three columns, T. Files of instruments and libraries that spectra_text recognises are read too; so are
/// tables with a spectrum in each row, in columns named by wavelengths, or in each column: all are R. Wavelengths below
/// 100 are in micrometres. A column is in percent if its name says so or, where no name has a unit, if most of its
/// values are above 1.5. Throws InputError with `name`, line and column.
MeasuredSpectra parse_measured_spectra(std::string_view text, const std::string& name, const SpectraMeasurement& how);

/// One leaf of a file with several.
struct MeasuredLeaf {
  std::string name;  ///< empty: the file has no names of leaves
  MeasuredSpectra spectra;
  std::string error = {};  ///< what is wrong with its rows, with file, line and column; empty: nothing
};

/// Reads all leaves of such a text, in the order of their first rows; `how.leaf` has no effect. Columns have one unit
/// for all leaves. What is wrong with the rows of one leaf becomes its `error`. Throws InputError for what is wrong
/// with the text as a whole, such as missing columns.
std::vector<MeasuredLeaf> parse_measured_leaves(std::string_view text, const std::string& name,
                                                const SpectraMeasurement& how);

/// Reads a file by `parse_measured_leaves`. Throws InputError, also if the file cannot be read.
std::vector<MeasuredLeaf> read_measured_leaves(const std::filesystem::path& path, const SpectraMeasurement& how);

/// Reads a file by `parse_measured_spectra`. Throws InputError, also if the file cannot be read.
MeasuredSpectra read_measured_spectra(const std::filesystem::path& path, const SpectraMeasurement& how);

}  // namespace frond::leaf
