#pragma once

#include <span>
#include <vector>

#include "core/wavelengths.h"
#include "spectra/matrix3.h"

namespace frond {

/// Returns for each band the CIE XYZ of a unit of radiance in it. The spectrum is taken as linear between the bands'
/// wavelengths and as constant beyond the first and the last. Empty if the bands do not cover the visible: fewer than
/// four, none at or below 450 nm, or none at or above 650 nm. Bands of one mean wavelength share its weight.
std::vector<Triple> xyz_of_bands(std::span<const Band> bands);

}  // namespace frond
