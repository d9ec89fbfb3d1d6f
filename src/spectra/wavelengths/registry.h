#pragma once

#include <span>

#include "core/wavelengths.h"

namespace frond {

/// The wavelength strategies of this layer.
std::span<const WavelengthsInfo* const> builtin_wavelengths();

}  // namespace frond
