#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/spectrum.h"
#include "spectra/tabulated.h"

namespace frond {

/// Reads a spectrum file: pbrt's .spd format, numbers in pairs of wavelength (nm) and value between white space, or a
/// table with a column of wavelengths and one of values, in any layout that TextTable reads; `#` starts a comment. The
/// wavelengths are in the column that is named so, or else in the first one. Of a table with several columns of values
/// "FILE:COLUMN" selects one. Throws InputError with the file's line and column if a number is malformed, if the column
/// is not clear or check_points rejects the points, and at `where` if the file cannot be read.
std::vector<SpectrumPoint> read_spd_points(const std::filesystem::path& path, const Location& where);

/// Reads the same formats from text; `column`: of values, "" if there is only one.
std::vector<SpectrumPoint> parse_spd_points(std::string_view text, const std::string& name,
                                            std::string_view column = {});

/// Reads the same formats as a spectrum that is linear between its points. Throws as read_spd_points does.
SpectrumPtr read_spd(const std::filesystem::path& path, const Location& where);

/// A spectrum file with the name of a column.
struct SpectrumColumn {
  std::filesystem::path file;
  std::string column;  ///< "": the only one
};
/// Returns the parts of "FILE:COLUMN", unless the whole is a file.
SpectrumColumn spectrum_column(const std::filesystem::path& path);

/// Returns the name of such a spectrum: the column's, else the file's without its ending.
std::string spectrum_name(const std::filesystem::path& path);

/// Returns whether a word is a spectrum file: not the name of a spectrum, but an existing file, with a column or
/// without, or a name that ends with .spd, .csv, .tsv or .txt. `path`: where the file would be.
bool is_spectrum_file(std::string_view word, const std::filesystem::path& path);

/// Returns the spectrum that a word names; reads the file at `path` if the word is a file. Throws InputError.
SpectrumPtr named_or_read_spectrum(std::string_view word, const std::filesystem::path& path, const Location& where);

}  // namespace frond
