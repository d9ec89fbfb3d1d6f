#pragma once

#include <string_view>

#include "core/error.h"
#include "core/wavelengths.h"

namespace frond {

/// Throws InputError at `where` unless data for the wavelengths `data_nm` cover all wavelengths of the render: data are
/// never extended silently, neither by zeros nor by their last value. `what` names the data in the message, for example
/// "reflectance".
void check_range(Interval data_nm, const WavelengthStrategy& wavelengths, const Location& where, std::string_view what);

/// Checks a light's emission in the same way; the message also names spectra that cover a wider range.
void check_light_range(const Spectrum& emission, const WavelengthStrategy& wavelengths, const Location& where,
                       std::string_view what);

/// Checks the range of a spectrum.
inline void check_range(const Spectrum& spectrum, const WavelengthStrategy& wavelengths, const Location& where,
                        std::string_view what) {
  check_range(spectrum.range_nm(), wavelengths, where, what);
}

}  // namespace frond
