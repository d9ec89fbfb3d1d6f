#pragma once

#include <string_view>

#include "core/error.h"
#include "core/wavelengths.h"

namespace frond {

/// Throws InputError at `where` unless data that stand in `data_nm` reach every wavelength that a render can ask for:
/// there is no silent zero and no silent hold. `what` names the data, as in: "reflectance".
void check_range(Interval data_nm, const WavelengthStrategy& wavelengths, const Location& where, std::string_view what);

/// The same for what a light gives off; the message says which lights reach further.
void check_light_range(const Spectrum& emission, const WavelengthStrategy& wavelengths, const Location& where,
                       std::string_view what);

inline void check_range(const Spectrum& spectrum, const WavelengthStrategy& wavelengths, const Location& where,
                        std::string_view what) {
  check_range(spectrum.range_nm(), wavelengths, where, what);
}

}  // namespace frond
