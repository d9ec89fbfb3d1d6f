#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/table/mode_table.h"

namespace frond::leaf {

/// One column of a file: the leaf at one wavelength and, in a table with depths, one optical depth.
struct ModeTableColumn {
  double lambda_nm, depth = 0;
  Location where;
};

/// Content of a mode table file, whose format docs/file_formats.md describes.
struct ModeTableFile {
  std::vector<ModeTableColumn> columns;
  ModeTable spectrum;  ///< `index` by column

  std::vector<double> wavelengths_nm() const;
};

/// Returns the file's text. `header`: lines that each begin with `#`. Numbers are written such that they are read to
/// the same bits.
std::string to_text(const ModeTableRequest& request, const ModeTable& spectrum, std::string_view header);

/// Parses a file's text. Throws InputError with `name`, line and column of the fault: another format, numbers out of
/// range, or columns that scatter more light than is incident.
ModeTableFile parse_mode_table_file(std::string_view text, const std::string& name);

/// Reads a file. Throws InputError as `parse_mode_table_file` does, or at `where` if the file cannot be read.
ModeTableFile read_mode_table_file(const std::filesystem::path& path, const Location& where);

/// Returns the table at other wavelengths: linear between the file's, constant beyond them. For files without depths.
ModeTable at_wavelengths(const ModeTableFile& file, const std::vector<double>& wavelengths_nm);

}  // namespace frond::leaf
