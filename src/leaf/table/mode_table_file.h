#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// One column of a file: the leaf at one wavelength and, where that varies, optical depth.
struct ModeTableColumn {
  double lambda_nm, depth = 0;
  Location where;
};

/// A spectrum of modes and what its columns are: the format that docs/table_format.md describes.
struct ModeTableFile {
  std::vector<ModeTableColumn> columns;
  ModeTable spectrum;  ///< `index` by column

  std::vector<double> wavelengths_nm() const;
};

/// `header` is a number of lines that each begin with `#`; numbers read back to the bit.
std::string to_text(const ModeTableRequest& request, const ModeTable& spectrum, std::string_view header);

/// Throws InputError with `name`, line and column of what is wrong: what is no such file, numbers out of range, and
/// columns that give back more light than there was.
ModeTableFile parse_mode_table_file(std::string_view text, const std::string& name);

/// Throws InputError as `parse_mode_table_file` does, or at `where` if the file cannot be read.
ModeTableFile read_mode_table_file(const std::filesystem::path& path, const Location& where);

/// Linearly between the file's wavelengths, beyond them the nearest. For files without depths.
ModeTable at_wavelengths(const ModeTableFile& file, const std::vector<double>& wavelengths_nm);

}  // namespace frond::leaf
