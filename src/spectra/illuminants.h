#pragma once

#include "core/spectrum.h"

namespace frond {

/// CIE standard illuminant A, 300 to 830 nm: 100 at 560 nm. Light of a tungsten filament.
SpectrumPtr illuminant_a();

/// CIE illuminant E, equal energy: 100 at every wavelength from 300 to 2500 nm.
SpectrumPtr illuminant_e();

// Phases of daylight, 300 to 830 nm: 100 at 560 nm. CIE 15:2004, 3.1. pbrt-v4's table of D50 has another chromaticity,
// (0.337, 0.358), than the CIE's (0.3457, 0.3585).
SpectrumPtr d50();
SpectrumPtr d55();
SpectrumPtr d75();

/// The same for 6000 K of today's scale: the white of ACES.
SpectrumPtr aces_d60();

}  // namespace frond
