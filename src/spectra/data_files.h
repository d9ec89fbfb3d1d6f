#pragma once

#include <string_view>

namespace frond {

/// Files of src/spectra/data, put into the library by CMake.
extern const std::string_view solar_csv;
extern const std::string_view named_csv;

}  // namespace frond
