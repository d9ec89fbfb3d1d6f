#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>
#include <span>
#include <vector>

#include "core/spectrum.h"
#include "leaf/solve/quadrature.h"
#include "leaf/tissue/tissue.h"

/// Shared by the solvers of the walk. Included by their .cpp files alone, which keeps Eigen out of other modules.
namespace frond::leaf {

/// Directions in one medium: cosines to the normal and their quadrature weights. Node i has the same k = n sin theta in
/// every medium that has it.
struct Directions {
  Eigen::VectorXd mu, weight;
};

/// Returns the modes over azimuth of lobes from many axes toward many directions: the matrix [mode](axis, direction)
/// holds means over azimuth of (cos alpha)^e cos(m phi).
std::vector<Eigen::MatrixXd> lobe_modes(double exponent, const Eigen::VectorXd& axes, const Eigen::VectorXd& directions,
                                        size_t modes);

class LobeMeans;

/// The walk through one leaf as a Markov chain, one mode of azimuth at a time, without absorption.
///
/// No event of the walk depends on the azimuth. So mode m of the rays' density, its integral over azimuth with cos(m
/// phi), changes independently of the others: a lobe multiplies it by the lobe's own mode, ideal refraction and
/// reflection leave it unchanged. Mode 0 is the density of mu = |cos theta|. The states are (medium, up or down, mu).
/// mu is discretised by composite Gauss quadrature in k = n sin theta, which refraction keeps: one set of nodes serves
/// all media, and unperturbed refraction stays on it. Segments end at the critical angles and are graded towards
/// grazing; in each, the cosine in the medium where the segment ends at grazing is the variable, so that Fresnel's
/// square-root kink is smooth.
class Chain {
 public:
  static constexpr size_t kFirst = 1, kLast = 5;  ///< media of the leaf

  /// Modes 0 to `modes` - 1. `tissue` must outlive the chain.
  Chain(const Tissue& tissue, int nodes, size_t modes) : Chain(tissue, NodeRule{nodes}, modes, nullptr) {}
  /// The same with another rule. `means`, unless it is nullptr, gives mode 0 of the lobes, the only one: much faster
  /// for exponents that are not whole.
  Chain(const Tissue& tissue, const NodeRule& rule, size_t modes, LobeMeans* means);

  const Tissue& tissue() const { return tissue_; }
  /// As given to the constructor.
  LobeMeans* means() const { return means_; }
  /// Nodes of a medium of the leaf, kFirst to kLast.
  const Directions& directions(size_t medium) const { return directions_[medium]; }
  Eigen::Index count(size_t medium) const { return directions_[medium].mu.size(); }

  /// Transition matrix from the states in `medium` going up or down to the states in the medium that the branch leads
  /// to. Not for branches that leave the leaf.
  Eigen::MatrixXd branch(size_t mode, size_t medium, bool up, bool refracts) const;
  /// Densities per unit of cosine from the same states to other directions in that medium, times the branch's
  /// probability: `toward` holds the modes of the branch's lobe with that medium's nodes as axes.
  Eigen::MatrixXd branch_density(const Eigen::MatrixXd& toward, size_t medium, bool up, bool refracts) const;

  /// Probability, by node, that a ray takes the branch at the next interface (Fresnel).
  Eigen::VectorXd probability(size_t medium, bool up, bool refracts) const;

 private:
  /// A lobe around each node of one medium.
  struct Kernel {
    std::vector<Eigen::MatrixXd> shares;  ///< [mode](axis, direction); rows of mode 0 sum to 1
    Eigen::VectorXd kept;                 ///< these sums before they were normalised
  };
  static size_t next(size_t medium, bool up) { return up ? medium - 1 : medium + 1; }
  const Lobe* lobe(size_t medium, bool up, bool refracts) const {
    return tissue_.lobe(up ? medium - 1 : medium, up, refracts);
  }
  const Kernel& kernel(const Lobe& lobe, size_t medium) const {
    return kernels_.at({lobe.exponent(), tissue_.n[medium]});
  }
  /// Number of nodes, the last ones, at which both interfaces of a medium reflect everything without a change of
  /// direction.
  Eigen::Index totally_reflected(size_t medium) const;
  void make_kernel(const Lobe& lobe, size_t medium, size_t modes);

  const Tissue& tissue_;
  LobeMeans* means_;
  std::array<Directions, Tissue::kMedia> directions_;
  std::map<std::pair<double, double>, Kernel> kernels_;  ///< by exponent and index
};

/// Smallest and largest exponent of the lobes inside the leaf.
Interval exponents_inside(const Tissue& tissue);

/// Adjoint sources: how much light in a state leaves the leaf at its next event, one column for each exit: the adaxial
/// side's exits, then the same number of the abaxial side's. An exit is a direction, or a side as a whole. [medium]; an
/// empty matrix means zeros.
struct Sources {
  std::array<Eigen::MatrixXd, Tissue::kMedia> down = {}, up = {};
  Eigen::Index ways = 0;  ///< columns
};

/// Shares of a ray that has just entered the leaf that leave it by each exit: rows are the ray's nodes in the
/// epidermis, columns the exits of Sources.
struct Prospects {
  Eigen::MatrixXd from_above, from_below;
};

/// Matrices of one mode of a chain. They do not depend on absorption, so leaves of different optical depths share them.
class ModeSolver {
 public:
  /// `chain` and `sources` must outlive the solver.
  ModeSolver(const Chain& chain, size_t mode, const Sources& sources);

  /// Solves with the absorption of `tissue`, which may differ from the chain's tissue in its optical depth. For a
  /// unifacial leaf, returns the mean over `places` positions of the air space.
  Prospects solve(const Tissue& tissue, int places) const;

 private:
  /// Share of light that each medium transmits (Beer's law), by node.
  using Survivals = std::array<Eigen::VectorXd, Tissue::kMedia>;

  Survivals survivals(const Tissue& tissue, double above) const;
  Eigen::MatrixXd source(const Survivals& survival, size_t medium, bool up) const;
  Prospects solve(const Survivals& survival) const;

  const Chain& chain_;
  const Sources& sources_;
  std::array<std::array<Eigen::MatrixXd, 2>, Tissue::kMedia> reflect_, refract_;  ///< [medium][up]
};

}  // namespace frond::leaf
