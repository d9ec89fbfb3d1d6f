#pragma once

#include "core/spectrum.h"

namespace frond {

/// Precision of M1 and M2, the factors of daylight's components S1 and S2.
enum class DaylightDigits {
  three,  ///< rounded to three decimals, as in the CIE's tables of its illuminants
  all,    ///< not rounded
};

/// Returns CIE daylight of a correlated colour temperature from 4000 to 25000 K (CIE 15:2004, 3.1), 300 to 830 nm. Its
/// value at 560 nm is 100.
SpectrumPtr cie_daylight(double kelvin, DaylightDigits digits);

/// Converts a colour temperature to the present scale (c2 = 1.4388e-2 m K) from that of 1931 (c2 = 1.4380e-2 m K),
/// after which the CIE's illuminants are named: D65 has 6504 K.
double kelvin_by_scale_of_1931(double kelvin);

/// Returns CIE daylight of a temperature on the scale of 1931, up to a constant factor. Below 4000 K (present scale),
/// where CIE daylight is not defined, it is a blackbody, as in pbrt-v4. `kelvin` in [1000, 1e5].
SpectrumPtr daylight(double kelvin);

}  // namespace frond
