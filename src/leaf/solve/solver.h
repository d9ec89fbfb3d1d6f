#pragma once

#include <span>
#include <vector>

#include "leaf/solve/quadrature.h"
#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Version of the solution. Increase with any change that may change results: tables on disk are stored under it.
inline constexpr int kSolverVersion = 6;

/// Shares of the light that meets the leaf at one angle that are reflected and transmitted; the rest is absorbed.
struct Shares {
  double surface = 0;      ///< Rs: reflected at the outer surface
  double subsurface = 0;   ///< Rd: reflected after it was inside the tissue
  double transmitted = 0;  ///< T: left by the other side

  friend bool operator==(const Shares&, const Shares&) = default;
};

/// Returns the shares, without noise, for light at theta degrees from +z, each in [0, 180]; above 90 the abaxial side
/// is lit.
///
/// Averaged over azimuth, an event of the walk depends on the ray's direction through mu = |cos theta| alone: this is
/// mode 0 of the chain of leaf/solve/chain.h.
///
/// `nodes` per segment, and twice as many positions of a unifacial leaf's air space.
std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg, int nodes);

/// Returns the number of nodes per segment for an error below 1e-5 if all lobes inside the leaf have exponents from 1
/// to 100 (the specimens' have 1 and 5); 3e-5 at 0.5; 4e-4 at 0, where the cut of the lobe leaves an edge. Found by
/// comparison with twice as many nodes and more.
int solver_nodes(const Tissue& tissue);

/// Shares with the nodes of `solver_nodes`.
std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg);

/// Shares for tissues that differ in their optical depth alone, which share the matrices: [tissue][angle].
std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg);
std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg,
                                              int nodes);

class LobeMeans;
/// The same with another rule, and twice its nodes as positions of a unifacial leaf's air space. `means`: lobe_mean.h.
std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg,
                                              const NodeRule& rule, LobeMeans& means);

}  // namespace frond::leaf
