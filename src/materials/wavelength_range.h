#pragma once

#include "core/material.h"
#include "core/texture.h"

namespace frond {

/// Throws where a render would carry wavelengths that a material's data do not have: there is no silent zero.
inline void check_range(const SpectrumTexture& texture, const WavelengthStrategy& wavelengths,
                        std::string_view parameter, const Location& where) {
  const Interval need = wavelengths.range_nm(), have = texture.range_nm();
  if (need.min >= have.min && need.max <= have.max) return;
  fail(where, "\"{}\" is known from {} to {} nm, the render needs {} to {} nm", parameter, have.min, have.max, need.min,
       need.max);
}

/// Values of the active lanes, 0 elsewhere.
inline SampledSpectrum active_lanes(SampledSpectrum s, const SampledWavelengths& lambda) {
  for (int i = 0; i < kLanes; ++i)
    if (!lambda.is_active(i)) s[i] = 0;
  return s;
}

}  // namespace frond
