#pragma once

#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// Returns the spectrum of a name: pbrt-v4's names, and in addition glass-SF5, -SF10, -SF11 (pbrt-v4's glass-F5, -F10,
/// -F11), stdillum-D55, -D75, -E and solar-*. Throws InputError for an unknown name, with a suggestion. Thread-safe.
SpectrumPtr named_spectrum(std::string_view name, const Location& where);

/// Returns all names that named_spectrum accepts, sorted.
std::vector<std::string_view> spectrum_names();

}  // namespace frond
