#include "leaf/solve/epidermis.h"

#include <algorithm>
#include <cmath>

#include "leaf/solve/lobe_mean.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

Eigen::PartialPivLU<MatrixXd> one_minus(const MatrixXd& m) {
  return Eigen::PartialPivLU<MatrixXd>(MatrixXd::Identity(m.rows(), m.cols()) - m);
}

}  // namespace

RowVectorXd spread(const Chain& chain, const Lobe& lobe, double mu_axis) {
  const Directions& to = chain.directions(kAdaxial);
  const VectorXd axis = VectorXd::Constant(1, mu_axis);
  const RowVectorXd lobe_means = chain.means() ? chain.means()->get(lobe.exponent()).row(mu_axis, to.mu)
                                               : RowVectorXd(lobe_modes(lobe.exponent(), axis, to.mu, 1)[0].row(0));
  const RowVectorXd row = lobe_means.cwiseProduct(to.weight.transpose());
  return row / row.sum();
}

VectorXd inner_cosines(std::span<const double> sines, double n) {
  VectorXd mu(static_cast<Index>(sines.size()));
  for (Index i = 0; i < mu.size(); ++i) {
    constexpr double kMost = 0.9999;
    const double sine = std::clamp(sines[static_cast<size_t>(i)] / n, -kMost, kMost);
    mu[i] = std::sqrt(1 - sine * sine);
  }
  return mu;
}

// Matrices as in Chain::branch.
Epidermis eliminate(const Chain& chain, size_t medium, size_t inner, const MatrixXd* directions) {
  const bool up = medium < inner;  // the direction outward
  const MatrixXd outer = chain.branch(0, medium, up, false), inside = chain.branch(0, medium, !up, false);
  const MatrixXd entering = chain.branch(0, medium, !up, true), leaving = chain.branch(0, inner, up, true);
  const VectorXd leaves = chain.probability(medium, up, true);
  MatrixXd sources(chain.count(medium), chain.count(inner) + 1);
  sources << entering, inside * leaves;
  Epidermis result;
  const auto lu = one_minus(inside * outer);
  result.inward = lu.solve(sources);
  MatrixXd outward = outer * result.inward;
  outward.rightCols(1) += leaves;
  const MatrixXd from_inner = leaving * outward;
  result.back = chain.branch(0, inner, up, false) + from_inner.leftCols(chain.count(inner));
  result.out = from_inner.rightCols(1);
  if (directions) {
    const MatrixXd reflected = lu.solve(chain.branch_density(*directions, medium, !up, false));
    result.toward = leaving * (outer * reflected) + chain.branch_density(*directions, inner, up, true);
  }
  return result;
}

// Rays down in the air space are `down` of (rays down in the upper part, rays up in the lower part).
MatrixXd eliminate_air_space(const Chain& chain) {
  const MatrixXd floor = chain.branch(0, kAir, false, false), ceiling = chain.branch(0, kAir, true, false);
  const MatrixXd to_lower = chain.branch(0, kAir, false, true), to_upper = chain.branch(0, kAir, true, true);
  const Index above = chain.count(kUpper), below = chain.count(kLower), all = above + below;
  MatrixXd sources(chain.count(kAir), all);
  sources << floor * to_upper, to_lower;
  const MatrixXd down = one_minus(floor * ceiling).solve(sources);
  MatrixXd up = ceiling * down;
  up.leftCols(above) += to_upper;
  MatrixXd inner(all, all);
  inner.topRows(above) = chain.branch(0, kUpper, false, true) * down;
  inner.bottomRows(below) = chain.branch(0, kLower, true, true) * up;
  inner.topLeftCorner(above, above) += chain.branch(0, kUpper, false, false);
  inner.bottomRightCorner(below, below) += chain.branch(0, kLower, true, false);
  return inner;
}

}  // namespace frond::leaf
