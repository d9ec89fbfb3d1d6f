#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/table/body_spectrum.h"

namespace frond::leaf {

/// One column of a file: the leaf at one wavelength and, where that varies, optical depth.
struct BodyColumn {
  double lambda_nm, depth = 0;
  Location where;
};

/// A spectrum of modes and what its columns are: the format that docs/table_format.md describes.
struct BodyFile {
  std::vector<BodyColumn> columns;
  BodySpectrum spectrum;  ///< `index` by column

  std::vector<double> wavelengths_nm() const;
};

/// `header` is a number of lines that each begin with `#`; numbers read back to the bit.
std::string to_text(const BodyRequest& request, const BodySpectrum& spectrum, std::string_view header);

/// Throws InputError with `name`, line and column of what is wrong: what is no such file, numbers out of range, and
/// columns that give back more light than there was.
BodyFile parse_body_file(std::string_view text, const std::string& name);

/// Throws InputError as `parse_body_file` does, or at `where` if the file cannot be read.
BodyFile read_body_file(const std::filesystem::path& path, const Location& where);

/// Linearly between the file's wavelengths, beyond them the nearest. For files without depths.
BodySpectrum at_wavelengths(const BodyFile& file, const std::vector<double>& wavelengths_nm);

}  // namespace frond::leaf
