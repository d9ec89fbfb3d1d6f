#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/spectrum.h"
#include "core/wavelengths.h"
#include "instruments/errors/statistics.h"
#include "spectra/wavelengths/radiant.h"

namespace frond {

/// Photosynthetically active radiation (PAR), 400 to 700 nm: converts shares of light by band to shares of photons.
struct PhotonWeights {
  std::vector<double> weights;  ///< by band; they sum to 1
  double incident = 0;          ///< incident photon flux density, umol m^-2 s^-1

  /// `irradiance`: on a horizontal plane, W m^-2 nm^-1. It is integrated over its own points; shares are taken as
  /// linear between the bands. Returns nullopt unless the bands, in any order, are single wavelengths that cover 400 to
  /// 700 nm, to within 10 nm, in steps of at most 50 nm. Throws InputError for an irradiance that is unknown or 0
  /// there.
  static std::optional<PhotonWeights> from_irradiance(std::span<const Band> bands, const Spectrum& irradiance);
  /// Returns whether the bands cover PAR, so that `from_irradiance` returns weights.
  static bool cover_par(std::span<const Band> bands);
  /// Returns the share of photons, from those by band. Its standard error is an upper bound, because bands share their
  /// paths.
  MeanError share(std::span<const MeanError> by_band) const;
};

}  // namespace frond
