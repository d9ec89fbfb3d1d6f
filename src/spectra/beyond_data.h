#pragma once

#include "core/spectrum.h"

namespace frond {

/// What holds in the visible where a spectrum's data do not reach.
enum class Beyond : uint8_t {
  zero,  ///< as pbrt-v4 reads tables
  held,  ///< the value at the nearest end
};

/// The spectrum, known over kCieRange_nm at least: beyond its data is what is said. The same one where its data reach.
SpectrumPtr known_in_the_visible(SpectrumPtr s, Beyond beyond);

}  // namespace frond
