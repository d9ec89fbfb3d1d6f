#pragma once

#include "core/spectrum.h"

namespace frond {

/// CIE standard daylight of a colour temperature (CIE 15:2004, 3.1), up to a factor; below 4000 K, where that is not
/// defined, a blackbody, as pbrt-v4 has it. `kelvin` in [1000, 1e5].
SpectrumPtr daylight(double kelvin);

}  // namespace frond
