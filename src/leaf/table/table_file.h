#pragma once

#include <filesystem>

#include "core/error.h"
#include "leaf/table/table.h"

namespace frond::leaf {

/// The format that docs/table_format.md describes. `header` is a number of lines that each begin with `#`; numbers read
/// back to the bit.
std::string to_csv(const Table& table, std::string_view header);

/// Throws InputError with `name`, line and column of what is wrong.
Table parse_table(std::string_view text, const std::string& name);

/// Throws InputError as `parse_table` does, or at `where` if the file cannot be read.
Table read_table(const std::filesystem::path& path, const Location& where);

}  // namespace frond::leaf
