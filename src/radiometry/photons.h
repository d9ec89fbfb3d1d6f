#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/spectrum.h"

namespace frond {

/// Photosynthetically active radiation, 400 to 700 nm, by photons: shares of light band by band become one of photons.
struct PhotonWeights {
  std::vector<double> weights;  ///< of the bands, by the trapezoid rule; they add up to 1
  double incident = 0;          ///< photon flux density of the light that falls in, umol m^-2 s^-1

  /// `irradiance`: of the horizontal plane, W m^-2 nm^-1. Empty where the bands, ascending, do not cover 400 to 700 nm,
  /// up to 10 nm, in steps of 50 nm at most.
  static std::optional<PhotonWeights> of(std::span<const double> bands_nm, const Spectrum& irradiance);
};

}  // namespace frond
