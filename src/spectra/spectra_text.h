#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "system/text_table.h"

namespace frond {

/// Returns whether the name, in any case and with or without a unit behind it, names a column of wavelengths.
bool names_wavelengths(std::string_view name);

/// Returns whether the unit behind such a name is the micrometre: "wavelength (um)".
bool is_in_micrometres(std::string_view name);

/// Returns the first column whose name is that of wavelengths.
std::optional<size_t> wavelength_column(const std::vector<TableField>& names);

/// Columns that are named by wavelengths, as in libraries with a spectrum in each row: "450", "X450", "Wave_450",
/// "450nm".
struct WavelengthNames {
  std::vector<size_t> columns;
  std::vector<std::string> nm;
};

/// Returns the columns of the prefix that most of them have; none if they are fewer than five.
WavelengthNames wavelength_names(const std::vector<TableField>& names);

/// Text of spectra as an instrument or a library exports it, as TextTable reads it.
struct SpectraText {
  /// The table with a line that names its columns: "wavelength", and "R" or "T" for what the layout states. Lines
  /// before it are empty, so that lines keep their numbers.
  std::string text;
  std::string_view layout;  ///< name of the layout, for messages; empty: `text` is what was given
};

/// Recognises files of Spectra Vista (.sig), Spectral Evolution (.sed), the libraries ECOSTRESS and ASTER, ASCII plots
/// of ENVI, NASA's SeaBASS, and tables whose line of names follows other lines (ASD's ViewSpec and others): the names
/// of their columns begin with that of wavelengths, and numbers follow.
SpectraText spectra_text(std::string_view text);

}  // namespace frond
