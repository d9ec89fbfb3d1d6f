#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Reads a leaf of a specimen file, a table with a row for each leaf (docs/file_formats.md): its name (`leaf`), the
/// specimen that has what is not given (`specimen`), the kind of leaf (`structure`, `sieve`, `absorption`) and numbers
/// of leaves by their names. Only a table of fits (`status`) may have other columns. `name`: the leaf; "" if there is
/// one row. Throws InputError with line and column, and at `where` if the file cannot be read.
TissueParams read_specimen(const std::filesystem::path& path, std::string_view name, const Location& where);

/// Reads the same from text; `file`: its name, for messages.
TissueParams parse_specimen(std::string_view text, const std::string& file, std::string_view name);

}  // namespace frond::leaf
