#pragma once

#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// A spectrum by the name that pbrt-v4 gives it, or one that it has not (glass-SF5, which it calls glass-F5, and the
/// like; stdillum-D55, -D75, -E; solar-*). Throws InputError that lists what there is.
SpectrumPtr named_spectrum(std::string_view name, const Location& where);

std::vector<std::string_view> spectrum_names();

}  // namespace frond
