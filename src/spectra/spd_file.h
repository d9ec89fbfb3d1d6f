#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/spectrum.h"
#include "spectra/tabulated.h"

namespace frond {

/// Reads a spectrum in pbrt's .spd format: pairs of wavelength (nm) and value, separated by white space; `#` starts a
/// comment. Throws InputError with the file's line and column if a number is malformed or check_points rejects the
/// points, and at `where` if the file cannot be read.
std::vector<SpectrumPoint> read_spd_points(const std::filesystem::path& path, const Location& where);

/// Reads the same format as a spectrum that is linear between its points. Throws as read_spd_points does.
SpectrumPtr read_spd(const std::filesystem::path& path, const Location& where);

}  // namespace frond
