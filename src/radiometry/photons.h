#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/spectrum.h"

namespace frond {

/// Photosynthetically active radiation (PAR), 400 to 700 nm: converts shares of light by band to shares of photons.
struct PhotonWeights {
  std::vector<double> weights;  ///< by band, by the trapezoid rule; they sum to 1
  double incident = 0;          ///< incident photon flux density, umol m^-2 s^-1

  /// `irradiance`: on a horizontal plane, W m^-2 nm^-1. Returns nullopt if the ascending bands do not cover 400 to 700
  /// nm, to within 10 nm, in steps of at most 50 nm.
  static std::optional<PhotonWeights> of(std::span<const double> bands_nm, const Spectrum& irradiance);
};

}  // namespace frond
