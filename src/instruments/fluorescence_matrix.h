#pragma once

#include <functional>
#include <vector>

#include "core/fluorescence.h"
#include "core/parallel.h"
#include "instruments/errors/statistics.h"

namespace frond {

/// Excitation-emission matrix of a specimen under parallel light of one angle: photons per incident photon, and per nm
/// of emission.
struct FluorescenceMatrix {
  /// Means at a pair of wavelengths; see FluorescencePhotons.
  struct Cell {
    Estimate absorbed, emitted, reabsorbed, lit_side, opposite_side;
  };
  double theta_deg = 0;  ///< from the front's normal to the light; above 90 the back is lit
  std::vector<double> excitation_nm, emission_nm;
  int64_t rays = 0;              ///< for each cell; 0: computed without noise
  std::vector<Cell> cells = {};  ///< [excitation][emission]

  const Cell& at(size_t excitation, size_t emission) const { return cells[excitation * emission_nm.size() + emission]; }
  /// Returns one of the members of Cell, integrated over the wavelengths of emission by the trapezoidal rule.
  Estimate integral(size_t excitation, Estimate Cell::*member) const;
};

/// What to measure, and how accurately.
struct FluorescenceRequest {
  double theta_deg;
  std::vector<double> excitation_nm, emission_nm;  ///< within kExcitation_nm and kEmission_nm
  int64_t rays;                                    ///< for each cell, if the fluorescence is a random estimate
  uint64_t seed = 0;
};

/// Measures all cells, each with random numbers of its own: they are independent, and the result is bitwise equal for
/// any number of threads. `progress` is called from one of them with the share that is done. Throws InputError for
/// fewer than 2 rays.
FluorescenceMatrix measure_fluorescence(const Fluorescence& fluorescence, const FluorescenceRequest& request,
                                        const ThreadPool& pool, const std::function<void(double)>& progress = {});

}  // namespace frond
