#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "leaf/solve/chain.h"
#include "leaf/solve/solver.h"

/// Shared by the solvers of the walk. Included by their .cpp files alone, which keeps Eigen out of other modules.
namespace frond::leaf {

/// Solves mode 0 of a chain for leaves that differ in their optical depth alone.
///
/// Only the two parts of the mesophyll absorb. Everything else, which is the epidermes and the air space, is eliminated
/// once: what remains is one linear system for the light that enters either part of the mesophyll.
class DepthSolver {
 public:
  /// Angles of incidence in degrees, as in `frond::leaf::solve`.
  DepthSolver(const Chain& chain, std::span<const double> theta_deg);

  /// Returns the shares by angle. `tissue`: the chain's, or one that differs in depth alone. For a unifacial leaf, the
  /// mean over `places` positions of the air space.
  std::vector<Shares> solve(const Tissue& tissue, int places) const;

 private:
  /// A ray that meets the leaf.
  struct Ray {
    double reflectance;  ///< of the outer surface
    size_t entrance;     ///< index in entrances_
  };
  /// Propagation of light that has just entered through one epidermis: shares that reach the nodes of the mesophyll
  /// next to it, and the share that leaves by the same side before.
  struct Entrance {
    bool is_above;  ///< the adaxial one
    Eigen::RowVectorXd inward;
    double back;
  };
  /// Shares of a ray's light, once inside, that leave by the side of incidence and by the other one.
  struct Outcome {
    double back = 0, across = 0;
  };

  /// Adds the outcomes of all entrances, times `weight`, for one position of the air space: `above` is the share of a
  /// moving mesophyll above it. Such a leaf's outcomes are the sum over this position and its mirror image.
  void add(const Tissue& tissue, double above, double weight, std::vector<Outcome>& sums) const;

  Eigen::VectorXd mu_above_, mu_below_;  ///< cosines of the nodes in media 2 and 4
  /// Light on its way out of the mesophyll's parts, at the outer interfaces: shares that come back, by node, and that
  /// leave the leaf.
  Eigen::MatrixXd back_above_, back_below_;
  Eigen::VectorXd out_above_, out_below_;
  /// From the light that leaves the mesophyll's parts toward the air space to the light that enters them from there.
  Eigen::MatrixXd inner_;
  std::vector<Ray> rays_;  ///< [angle]
  std::vector<Entrance> entrances_;
};

}  // namespace frond::leaf
