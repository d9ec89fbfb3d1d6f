#pragma once

#include "core/spectrum.h"

namespace frond {

/// Values of the active lanes, 0 elsewhere.
inline SampledSpectrum active_lanes(SampledSpectrum s, const SampledWavelengths& lambda) {
  for (int i = 0; i < kLanes; ++i)
    if (!lambda.is_active(i)) s[i] = 0;
  return s;
}

}  // namespace frond
