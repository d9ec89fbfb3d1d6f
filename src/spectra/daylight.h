#pragma once

#include "core/spectrum.h"

namespace frond {

/// Of the shares of daylight's components.
enum class DaylightDigits {
  three,  ///< after the point, as the CIE's own tables of its illuminants have them
  all,
};

/// Daylight of a correlated colour temperature from 4000 to 25000 K (CIE 15:2004, 3.1), 300 to 830 nm: 100 at 560 nm.
SpectrumPtr cie_daylight(double kelvin, DaylightDigits digits);

/// Of today's scale, for one by the constant c2 of 1931, 1.4380e-2 m K, by which illuminants have their names.
double kelvin_by_scale_of_1931(double kelvin);

/// CIE daylight of a temperature by the scale of 1931, up to a factor; below 4000 K, where that is not defined, a
/// blackbody, as pbrt-v4 has it. `kelvin` in [1000, 1e5].
SpectrumPtr daylight(double kelvin);

}  // namespace frond
