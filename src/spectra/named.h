#pragma once

#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// A spectrum by the name that pbrt-v4 gives it, or "stdillum-E", which pbrt-v4 has not. Throws InputError that lists
/// what there is.
SpectrumPtr named_spectrum(std::string_view name, const Location& where);

std::vector<std::string_view> spectrum_names();

}  // namespace frond
