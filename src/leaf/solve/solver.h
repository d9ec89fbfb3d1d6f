#pragma once

#include <span>
#include <vector>

#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Increase with any change that may change results: tables on disk are kept by it.
inline constexpr int kSolverVersion = 5;

/// What becomes of light that meets the leaf at one angle: shares of 1. The rest is absorbed.
struct Shares {
  double surface = 0;      ///< Rs: reflected at the outer surface
  double subsurface = 0;   ///< Rd: came back out of the tissue
  double transmitted = 0;  ///< T: left by the other side

  friend bool operator==(const Shares&, const Shares&) = default;
};

/// Shares for light at theta degrees from +z, each in [0, 180] (above 90 the abaxial side is lit), without noise.
///
/// Averaged over azimuth, what an event of the walk does depends on the ray's direction through mu = |cos theta| alone:
/// this is mode 0 of the chain of leaf/solve/chain.h.
///
/// `nodes` per segment, and twice as many places of a unifacial leaf's air space.
std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg, int nodes);

/// Enough nodes for an error below 1e-5 where all lobes inside the leaf have exponents from 1 to 100 (the specimens'
/// have 1 and 5); 3e-5 at 0.5; 4e-4 at 0, where the cut leaves an edge. Found by comparing with twice as many and more.
int solver_nodes(const Tissue& tissue);

/// With `solver_nodes`.
std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg);

/// The same for tissues that differ in their optical depth alone, with less work: [tissue][angle].
std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg);
std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg,
                                              int nodes);

}  // namespace frond::leaf
