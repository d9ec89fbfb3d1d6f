#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/spectrum.h"
#include "spectra/tabulated.h"

namespace frond {

/// Reads a spectrum from pbrt's .spd format: wavelength (nm) and value in turn, between white space; `#` starts a
/// comment. Two points at least, as check_points has them. Throws InputError with the file's line and column, or at
/// `where` if the file cannot be read.
std::vector<SpectrumPoint> read_spd_points(const std::filesystem::path& path, const Location& where);

/// The same as a spectrum.
SpectrumPtr read_spd(const std::filesystem::path& path, const Location& where);

}  // namespace frond
