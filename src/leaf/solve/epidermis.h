#pragma once

#include <Eigen/Dense>
#include <span>

#include "leaf/solve/chain.h"

/// Shared by the solvers of the walk. Included by their .cpp files alone, which keeps Eigen out of other modules.
namespace frond::leaf {

/// The layers that do not absorb, eliminated: what remains are the two parts of the mesophyll, the media kUpper and
/// kLower. "Inward" is from an epidermis toward the air space.
inline constexpr size_t kAdaxial = Chain::kFirst, kUpper = 2, kAir = 3, kLower = 4, kAbaxial = Chain::kLast;

/// An epidermis.
struct Epidermis {
  /// From light that moves inward there to the mesophyll's nodes, inward; the last column is the share that leaves.
  Eigen::MatrixXd inward;
  Eigen::MatrixXd back;  ///< from light that moves outward in the mesophyll to its nodes, inward
  Eigen::VectorXd out;   ///< and the share of it that leaves
  /// From light that moves outward in the mesophyll to densities of light inside the epidermis that moves outward along
  /// given directions, per unit of cosine, each time that it meets the outer surface. Empty unless asked for.
  Eigen::MatrixXd toward;
};

/// `medium`: of the epidermis; `inner`: of the mesophyll next to it. `directions`: modes 0 of the epidermis's lobe from
/// its nodes toward directions for `toward`; nullptr: none.
Epidermis eliminate(const Chain& chain, size_t medium, size_t inner, const Eigen::MatrixXd* directions = nullptr);

/// The air space: from light that leaves the mesophyll's parts inward to light that enters them outward. Rows and
/// columns are the nodes of the upper part, then those of the lower one.
Eigen::MatrixXd eliminate_air_space(const Chain& chain);

/// Returns the distribution over the nodes of an epidermis of light that has just entered it, around an axis with the
/// cosine `mu_axis`. Division by the sum replaces the cut and conserves energy exactly.
Eigen::RowVectorXd spread(const Chain& chain, const Lobe& lobe, double mu_axis);

/// Cosines of the directions inside that refract into those of the given sines. The last node of a grid lies beyond the
/// horizon, for interpolation below it; where the index is too low for a direction inside, the most grazing one is
/// taken.
Eigen::VectorXd inner_cosines(std::span<const double> sines, double n);

}  // namespace frond::leaf
