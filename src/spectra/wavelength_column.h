#pragma once

#include <optional>
#include <vector>

#include "system/text_table.h"

namespace frond {

/// Returns whether the name, in any case and with or without a unit behind it, names a column of wavelengths.
bool names_wavelengths(std::string_view name);

/// Returns the first column whose name is that of wavelengths.
std::optional<size_t> wavelength_column(const std::vector<TableField>& names);

}  // namespace frond
