#pragma once

#include <string_view>
#include <vector>

#include "spectra/tabulated.h"

namespace frond {

/// Returns a column of a file of src/spectra/data (data_files.h), by wavelength (nm). Throws std::logic_error if there
/// is no such column.
std::vector<SpectrumPoint> table_column(std::string_view csv, std::string_view name);

/// Returns a column of named.csv, as table_column does.
std::vector<SpectrumPoint> named_column(std::string_view name);

/// Returns the same column as a spectrum. A table that ends within kCieRange_nm is extended to the ends of that
/// interval by its first and last value, as in pbrt-v4.
SpectrumPtr named_table(std::string_view name);

}  // namespace frond
