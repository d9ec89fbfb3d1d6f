#pragma once

#include "core/spectrum.h"

namespace frond {

// Spectral irradiance of the sun in W m^-2 nm^-1, 300 to 2500 nm. Source: ASTM G173-03.
SpectrumPtr solar_am0();          ///< extraterrestrial: outside the atmosphere
SpectrumPtr solar_am15_global();  ///< air mass 1.5, sun and sky, on a plane tilted by 37 degrees towards the sun
SpectrumPtr solar_am15_direct();  ///< air mass 1.5, direct beam and circumsolar light

}  // namespace frond
