#pragma once

#include "core/spectrum.h"

namespace frond {

/// Returns 1 in active lanes, 0 elsewhere.
inline SampledSpectrum lane_mask(const SampledWavelengths& lambda) {
  SampledSpectrum mask;
  for (size_t i = 0; i < kLanes; ++i) mask[int(i)] = static_cast<float>(lambda.active[i]);
  return mask;
}

}  // namespace frond
