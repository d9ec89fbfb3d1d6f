#pragma once

#include "core/spectrum.h"

namespace frond {

/// CIE standard illuminant A, 300 to 830 nm: 100 at 560 nm. Light of a tungsten filament.
SpectrumPtr illuminant_a();

/// CIE illuminant E, equal energy: 100 at every wavelength from 300 to 2500 nm.
SpectrumPtr illuminant_e();

}  // namespace frond
