#pragma once

#include <string_view>

namespace frond {

// Files of src/spectra/data, which CMake embeds in the library. Lines that begin with # are comments with the sources.
extern const std::string_view solar_csv;     ///< wavelength (nm), extraterrestrial, global, direct (W m^-2 nm^-1)
extern const std::string_view spectrl2_csv;  ///< see spectrl2.cpp
extern const std::string_view named_csv;     ///< blocks, each with a line of column names that begins with "nm,"
extern const std::string_view soil_csv;      ///< soils' vectors and the absorption of water (1/m), as named_csv

}  // namespace frond
