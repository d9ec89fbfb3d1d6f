#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>
#include <span>
#include <vector>

#include "core/spectrum.h"
#include "leaf/tissue/tissue.h"

/// What the solvers of the walk share. For their .cpp files alone: nobody else needs to see Eigen.
namespace frond::leaf {

/// Directions in one medium: cosines to the normal and their quadrature weights. Node i is the same k = n sin theta in
/// every medium that has it.
struct Directions {
  Eigen::VectorXd mu, weight;
};

/// Lobes from many axes toward many directions, mode by mode of azimuth: the matrix [mode](axis, direction) holds means
/// over azimuth of (cos alpha)^e cos(m phi).
std::vector<Eigen::MatrixXd> lobe_modes(double exponent, const Eigen::VectorXd& axes, const Eigen::VectorXd& directions,
                                        size_t modes);

/// The walk through one leaf as a Markov chain, mode by mode of azimuth, except for what the media absorb.
///
/// No event of the walk prefers an azimuth. So the mode m of the rays' density, its integral over azimuth with
/// cos(m phi), passes the events without the others: a lobe multiplies it by the lobe's own mode, ideal refraction and
/// reflection leave it as it is. Mode 0 is the density of mu = |cos theta|. The states are (medium, up or down, mu).
/// mu is discretised by composite Gauss quadrature in k = n sin theta, which refraction keeps: one set of nodes serves
/// all media, and unperturbed refraction stays on it. Segments end at the critical angles and are graded towards
/// grazing; in each, the cosine in the medium where the segment ends at grazing is the variable, so that Fresnel's
/// square-root kink is smooth.
class Chain {
 public:
  static constexpr size_t kFirst = 1, kLast = 5;  ///< media of the leaf

  /// `nodes` per segment. `tissue` must outlive it.
  Chain(const Tissue& tissue, int nodes, size_t modes);

  const Tissue& tissue() const { return tissue_; }
  const Directions& directions(size_t medium) const { return directions_[medium]; }
  Eigen::Index count(size_t medium) const { return directions_[medium].mu.size(); }

  /// States in `medium` going up or down, to states in the medium that the branch leads to. Not for ways out.
  Eigen::MatrixXd branch(size_t mode, size_t medium, bool up, bool refracts) const;
  /// From the same states to other directions in that medium: `toward` are the modes of the branch's lobe from the
  /// nodes of that medium as its axes. Densities per unit of cosine, with the branch's chance.
  Eigen::MatrixXd branch_density(const Eigen::MatrixXd& toward, size_t medium, bool up, bool refracts) const;

  /// Chance of the ray to take the branch at the interface ahead.
  Eigen::VectorXd chance(size_t medium, bool up, bool refracts) const;

 private:
  /// A lobe around each node of one medium.
  struct Kernel {
    std::vector<Eigen::MatrixXd> shares;  ///< [mode](axis, direction); rows of mode 0 sum to 1
    Eigen::VectorXd kept;                 ///< what these sums were before
  };
  static size_t next(size_t medium, bool up) { return up ? medium - 1 : medium + 1; }
  const Lobe* lobe(size_t medium, bool up, bool refracts) const {
    return tissue_.lobe(up ? medium - 1 : medium, up, refracts);
  }
  const Kernel& kernel(const Lobe& lobe, size_t medium) const {
    return kernels_.at({lobe.exponent(), tissue_.n[medium]});
  }
  /// Nodes at which both interfaces of a medium reflect everything, and change no direction: the last ones.
  Eigen::Index held_for_ever(size_t medium) const;
  void make_kernel(const Lobe& lobe, size_t medium, size_t modes);

  const Tissue& tissue_;
  std::array<Directions, Tissue::kMedia> directions_;
  std::map<std::pair<double, double>, Kernel> kernels_;  ///< by exponent and index
};

/// Least and greatest of the lobes' exponents in the leaf.
Interval exponents_inside(const Tissue& tissue);

/// Worth of being in a state for light that is about to leave in the ways asked for, one column each: the adaxial
/// side's ways first and as many of the abaxial side's. For states [medium]; an empty matrix stands for zeros.
struct Sources {
  std::array<Eigen::MatrixXd, Tissue::kMedia> down = {}, up = {};
  Eigen::Index ways = 0;  ///< columns
};

/// What awaits a ray that has just entered the leaf, by its node in the epidermis (rows) and by ways out (columns).
struct Prospects {
  Eigen::MatrixXd from_above, from_below;
};

/// One mode's matrices, which do not know of absorption: leaves of other depths share them.
class ModeSolver {
 public:
  /// Both must outlive it.
  ModeSolver(const Chain& chain, size_t mode, const Sources& sources);

  /// With the absorption of `tissue`, which may differ from the chain's in its depth. Where the air space moves, the
  /// mean over `places` of it.
  Prospects solve(const Tissue& tissue, int places) const;

 private:
  /// Shares of light that the media let through, by node.
  using Survivals = std::array<Eigen::VectorXd, Tissue::kMedia>;

  Survivals survivals(const Tissue& tissue, double above) const;
  Eigen::MatrixXd source(const Survivals& survival, size_t medium, bool up) const;
  Prospects solve(const Survivals& survival) const;

  const Chain& chain_;
  const Sources& sources_;
  std::array<std::array<Eigen::MatrixXd, 2>, Tissue::kMedia> reflect_, refract_;  ///< [medium][up]
};

}  // namespace frond::leaf
