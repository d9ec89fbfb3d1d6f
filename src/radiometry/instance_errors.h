#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "radiometry/flux.h"
#include "radiometry/photons.h"

namespace frond {

/// Relative standard errors of the light that single instances absorb: of PAR photons, or, if there are none, in the
/// band with the largest median. Only instances count that are not dark and whose standard error is known, that is,
/// that absorbed light of some path. Stochastic BSDFs have weights above 1, so that a mean of few paths may be 0 or
/// negative: its relative error is infinite.
struct InstanceErrors {
  std::string light;                   ///< "PAR photons", "light at 550 nm"
  double median = NAN, largest = NAN;  ///< NaN if no instance counts
  size_t known = 0;                    ///< number of instances that count
};

/// Returns the errors of a measurement by instance.
InstanceErrors instance_errors(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons);

}  // namespace frond
