#pragma once

#include <array>
#include <span>
#include <vector>

#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Fluorescence by the chain of leaf/solve/chain.h, without noise: the density of absorption by depth at the wavelength
/// of excitation is the source at the wavelength of emission. Emission is isotropic and forgets the azimuth, so that
/// mode 0 suffices. Both solutions are given at the same depths of all leaves of one structure; a pair of wavelengths
/// costs a sum of products over the depths.

/// Values by angle: [index of the sine][depth].
using ByDepth = std::vector<std::vector<double>>;

/// Light that has entered a leaf at the wavelength of excitation.
struct SolvedExcitation {
  /// Share of it that the mesophyll absorbs about each depth; [from_below]. The sum over the depths is all that is
  /// absorbed.
  std::array<ByDepth, 2> absorbed;
};

/// Light that is emitted isotropically at each depth, at the wavelength of emission.
struct SolvedEmission {
  std::array<std::vector<double>, 2> left;  ///< share that leaves, [below][depth]
  std::vector<double> reabsorbed;           ///< share that the tissue absorbs, [depth]
  /// Directional distribution; [below]. Times (1 - F_o) / mu_o' (`passage` has the factors) it is the radiance outside
  /// of one emitted photon per area, 1/sr.
  std::array<ByDepth, 2> toward;
};

/// `sines`: grid of sin theta outside, as in solve_modes. `nodes` per segment (mode_nodes).
SolvedExcitation solve_excitation(const Tissue& tissue, std::span<const double> sines, int nodes);
SolvedEmission solve_emission(const Tissue& tissue, std::span<const double> sines, int nodes);

}  // namespace frond::leaf
