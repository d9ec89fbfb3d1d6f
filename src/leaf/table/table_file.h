#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/table/table.h"

namespace frond::leaf {

/// Returns the table in the format of docs/file_formats.md. `header`: lines that each begin with `#`. Numbers are
/// written such that they are read to the same bits.
std::string to_csv(const Table& table, std::string_view header);

/// Parses a table. Throws InputError with `name`, line and column of the fault.
Table parse_table(std::string_view text, const std::string& name);

/// Returns whether the text is to be read as a leaf table rather than as measured spectra: whether its first row names
/// a column "Rs" or "Rd". A file without rows, or that is no text, is neither; `parse_table` reports it.
bool is_leaf_table(std::string_view text);

/// Reads a table. Throws InputError as `parse_table` does, or at `where` if the file cannot be read.
Table read_table(const std::filesystem::path& path, const Location& where);

}  // namespace frond::leaf
