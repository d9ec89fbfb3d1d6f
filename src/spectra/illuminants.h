#pragma once

#include "core/spectrum.h"

namespace frond {

/// CIE standard illuminant A, the light of a tungsten filament: 300 to 830 nm, 100 at 560 nm (CIE S 014-2:2006).
SpectrumPtr illuminant_a();

/// CIE illuminant E, equal energy: 100 at every wavelength from 300 to 2500 nm.
SpectrumPtr illuminant_e();

/// CIE daylight illuminant D50: 300 to 830 nm, 100 at 560 nm (CIE 15:2004, 3.1). Its chromaticity is the CIE's (0.3457,
/// 0.3585); that of pbrt-v4's table is (0.337, 0.358).
SpectrumPtr d50();
/// CIE daylight illuminant D55: 300 to 830 nm, 100 at 560 nm (CIE 15:2004, 3.1).
SpectrumPtr d55();
/// CIE daylight illuminant D75: 300 to 830 nm, 100 at 560 nm (CIE 15:2004, 3.1).
SpectrumPtr d75();

/// White of ACES: CIE daylight of 6000 K by the present temperature scale, 300 to 830 nm, 100 at 560 nm.
SpectrumPtr aces_d60();

}  // namespace frond
