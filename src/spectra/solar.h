#pragma once

#include "core/spectrum.h"

namespace frond {

/// Spectral irradiance of the sun, W m^-2 nm^-1, from 300 to 2500 nm; ASTM G173-03.
SpectrumPtr solar_am0();          ///< outside the atmosphere
SpectrumPtr solar_am15_global();  ///< air mass 1.5, on a plane that faces the sun at 37 degrees
SpectrumPtr solar_am15_direct();  ///< air mass 1.5, from the sun and what is close around it

}  // namespace frond
