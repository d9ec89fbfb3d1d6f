#pragma once

#include <span>

#include "core/wavelengths.h"

namespace frond {

/// Returns the plug-in records of the built-in wavelength strategies: smpte, hero, meyer, bands.
std::span<const WavelengthsInfo* const> builtin_wavelengths();

}  // namespace frond
