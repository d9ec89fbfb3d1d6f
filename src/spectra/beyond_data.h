#pragma once

#include "core/spectrum.h"

namespace frond {

/// Value of a spectrum at wavelengths for which it has no data.
enum class Beyond : uint8_t {
  zero,  ///< 0, as in pbrt-v4's tables
  held,  ///< the value at the nearest end of the data
};

/// Returns the spectrum extended to cover a range, with values beyond its data according to `beyond`. Returns the
/// spectrum itself if its data cover the range.
SpectrumPtr beyond_data(SpectrumPtr s, Beyond beyond, Interval range_nm);

/// Returns the spectrum that beyond_data has extended; nullptr for any other spectrum.
const Spectrum* base_of_extended(const Spectrum& s);

}  // namespace frond
