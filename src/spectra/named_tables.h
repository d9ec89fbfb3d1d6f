#pragma once

#include <string_view>
#include <vector>

#include "spectra/tabulated.h"

namespace frond {

/// A column of src/spectra/data/named.csv against its wavelengths.
std::vector<SpectrumPoint> named_column(std::string_view name);

/// The same as a spectrum. Where the table ends within kCieRange_nm its last value holds up to there, as in pbrt-v4.
SpectrumPtr named_table(std::string_view name);

}  // namespace frond
