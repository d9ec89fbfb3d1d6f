#pragma once

#include <span>

#include "core/spectrum.h"

namespace frond {

/// Returns the spectrum with its values at these wavelengths (nm) stored: `sample` needs no look-up for paths that
/// carry exactly them. Returns the spectrum itself if there are no wavelengths or more than kLanes.
SpectrumPtr precompute_at(SpectrumPtr spectrum, std::span<const float> nm);

/// Returns the spectrum whose values precompute_at has stored; nullptr for any other spectrum.
const Spectrum* base_of_precomputed(const Spectrum& spectrum);

}  // namespace frond
