#pragma once

#include <functional>

#include "core/fluorescence.h"
#include "core/math/distribution.h"
#include "core/spectrum.h"

namespace frond {

/// Samples wavelengths of excitation, four at a time, at equal steps of the integral of their density.
class ExcitationSampler {
 public:
  /// The density is mostly in proportion to `photons(nm)`, an estimate of the photons that a material absorbs per nm; a
  /// tenth is uniform, so that no weight is large where the estimate is too small.
  explicit ExcitationSampler(const std::function<double(double)>& photons);

  /// Wavelengths for a uniform u in [0, 1), with their densities (1/nm).
  SampledWavelengths sample(float u) const;

 private:
  Distribution1D cells_;
};

}  // namespace frond
