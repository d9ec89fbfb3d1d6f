#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// Reads a spectrum from pbrt's .spd format: wavelength (nm) and value in turn, between white space; `#` starts a
/// comment. Throws InputError with the file's line and column, or at `where` if the file cannot be read.
SpectrumPtr read_spd(const std::filesystem::path& path, const Location& where);

}  // namespace frond
