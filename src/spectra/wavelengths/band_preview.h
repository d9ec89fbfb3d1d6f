#pragma once

#include <span>
#include <vector>

#include "core/wavelengths.h"
#include "spectra/matrix3.h"

namespace frond {

/// Shares in CIE XYZ of a unit of radiance in each band, such that the spectrum between the bands' wavelengths is
/// linear and beyond them that of the nearest. Empty where the bands say too little of what the eye sees: fewer than
/// four, or none below 450 and above 650 nm.
std::vector<Triple> xyz_of_bands(std::span<const Band> bands);

}  // namespace frond
