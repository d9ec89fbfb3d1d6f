#pragma once

#include "core/error.h"
#include "core/spectrum.h"
#include "spectra/cie.h"

namespace frond {

/// Coefficients of a substance, 1/mm.
struct SubstanceCoefficients {
  SpectrumPtr sigma_a;  ///< absorption
  SpectrumPtr sigma_s;  ///< reduced scattering, (1 - g) sigma_s
};

/// Wavelengths (nm) of the coefficients of named substances, which are colours.
inline constexpr Interval kSubstanceRange_nm = kCieRange_nm;

/// Coefficients of a measured substance by pbrt-v4's name, as "Skin1". Throws InputError for an unknown name; `what`
/// is the parameter's noun in the message.
SubstanceCoefficients substance_coefficients(std::string_view name, const Location& where, std::string_view what);

}  // namespace frond
