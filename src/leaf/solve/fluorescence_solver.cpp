#include "leaf/solve/fluorescence_solver.h"

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "leaf/solve/epidermis.h"
#include "leaf/solve/quadrature.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

/// Points of a part of the mesophyll by their distance from the epidermis, as a share of its thickness, and their
/// weights. Graded toward both boundaries, where grazing light is absorbed. Symmetric about 1/2.
const std::vector<QuadratureNode>& depth_rule() {
  static const std::vector<QuadratureNode> rule = [] {
    constexpr double kBounds[] = {0, 0.01, 0.06, 0.2, 0.5, 0.8, 0.94, 0.99, 1};
    constexpr int kNodes = 4;
    std::vector<QuadratureNode> nodes;
    for (size_t i = 0; i + 1 < std::size(kBounds); ++i)
      for (const auto& [x, weight] : gauss_legendre(kNodes))
        nodes.push_back({std::lerp(kBounds[i], kBounds[i + 1], x), weight * (kBounds[i + 1] - kBounds[i])});
    return nodes;
  }();
  return rule;
}

/// A position of the air space: share of a moving mesophyll above it. The change of variable is that of DepthSolver.
struct Position {
  double above, weight;
};
std::vector<Position> positions(const Tissue& tissue, int count) {
  if (!tissue.air_space_moves) return {{1, 1}};
  std::vector<Position> all;
  for (const auto& [s, weight] : gauss_legendre(count)) all.push_back({s * s * (3 - 2 * s), weight * 6 * s * (1 - s)});
  return all;
}

MatrixXd block_diagonal(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd result = MatrixXd::Zero(a.rows() + b.rows(), a.cols() + b.cols());
  result.topLeftCorner(a.rows(), a.cols()) = a;
  result.bottomRightCorner(b.rows(), b.cols()) = b;
  return result;
}

/// The two parts of the mesophyll, between eliminated layers. States are rays that start to cross a part, inward or
/// outward; rows are the nodes of the upper part, then those of the lower one.
class Mesophyll {
 public:
  Mesophyll(const Tissue& tissue, std::span<const double> sines, int nodes)
      : tissue_(tissue),
        chain_(tissue, nodes, 1),
        axes_(inner_cosines(sines, tissue.n_cuticle())),
        directions_(lobe_modes(tissue.lobe(0, false, true)->exponent(), chain_.directions(kAdaxial).mu, axes_, 1)[0]),
        top_(eliminate(chain_, kAdaxial, kUpper, &directions_)),
        bottom_(eliminate(chain_, kAbaxial, kLower, &directions_)),
        inner_(eliminate_air_space(chain_)),
        back_(block_diagonal(top_.back, bottom_.back)),
        upper_(chain_.count(kUpper)),
        all_(inner_.rows()) {}

  /// Sets the position of the air space.
  void place(double above) {
    double upper_depth = tissue_.optical_depth[kUpper], lower_depth = tissue_.optical_depth[kLower];
    if (tissue_.air_space_moves) upper_depth *= above, lower_depth *= 1 - above;
    attenuation_.resize(all_);
    for (Index i = 0; i < all_; ++i)
      attenuation_[i] = path_depth(i < upper_ ? upper_depth : lower_depth, mu(i), tissue_.sieve_and_detour);
    kept_ = (-attenuation_.array()).exp();
    through_ = kept_.asDiagonal() * inner_;  // from rays that cross inward to rays that start outward
    const MatrixXd returning = through_ * kept_.asDiagonal() * back_;
    system_ = MatrixXd::Identity(all_, all_) - returning;
  }

  /// Adds the absorption of light that has entered from one side, by depth: rows are the directions of `sines`.
  MatrixXd absorbed(bool from_below) const {
    MatrixXd inward = MatrixXd::Zero(axes_.size(), all_);
    const Lobe& lobe = *tissue_.lobe(0, false, true);
    const Epidermis& epidermis = from_below ? bottom_ : top_;
    const Index count = epidermis.inward.cols() - 1;
    for (Index i = 0; i < axes_.size(); ++i)
      inward.row(i).segment(from_below ? upper_ : 0, count) =
          (spread(chain_, lobe, axes_[i]) * epidermis.inward).head(count);
    inward = Eigen::PartialPivLU<MatrixXd>(system_.transpose()).solve(inward.transpose()).transpose().eval();
    const MatrixXd outward = inward * through_;
    const size_t depths = depth_rule().size();
    MatrixXd result = MatrixXd::Zero(axes_.size(), static_cast<Index>(2 * depths));
    for (Index i = 0; i < all_; ++i) {
      const RowVectorXd kernel = absorption_by_depth(i);
      auto part = result.middleCols(i < upper_ ? 0 : kernel.size(), kernel.size());
      part += inward.col(i) * kernel + outward.col(i) * kernel.reverse();
    }
    return result;
  }

  /// Returns, for light emitted at each depth (rows), the shares that leave above and below and that are absorbed, then
  /// the densities toward the directions above and below.
  MatrixXd emitted() const {
    const Index ways = axes_.size(), lower = all_ - upper_;
    MatrixXd out = MatrixXd::Zero(all_, 3 + 2 * ways);  // values of rays that meet an epidermis
    out.col(0).head(upper_) = top_.out, out.col(1).tail(lower) = bottom_.out;
    out.block(0, 3, upper_, ways) = top_.toward, out.block(upper_, 3 + ways, lower, ways) = bottom_.toward;
    RowVectorXd absorbed = RowVectorXd::Zero(out.cols());
    absorbed[2] = 1;
    const VectorXd lost = 1 - kept_.array(), trapped = 1 - inner_.rowwise().sum().array();
    // Values of rays that start inward; those that total reflection keeps in a smooth layer are absorbed there.
    const VectorXd ends = through_ * lost + lost + kept_.cwiseProduct(trapped);
    const MatrixXd inward =
        Eigen::PartialPivLU<MatrixXd>(system_).solve(MatrixXd(through_ * kept_.asDiagonal() * out + ends * absorbed));
    const MatrixXd meets_epidermis = out + back_ * inward;
    const MatrixXd meets_air = inner_ * (kept_.asDiagonal() * meets_epidermis + lost * absorbed) + trapped * absorbed;

    const VectorXd isotropic = isotropic_shares();
    const std::vector<QuadratureNode>& rule = depth_rule();
    MatrixXd result = MatrixXd::Zero(static_cast<Index>(2 * rule.size()), out.cols());
    for (Index part = 0; part < 2; ++part) {
      const Index first = part == 0 ? 0 : upper_, count = part == 0 ? upper_ : lower;
      for (size_t k = 0; k < rule.size(); ++k) {
        const auto share = isotropic.segment(first, count).array();
        const auto attenuation = attenuation_.segment(first, count).array();
        const VectorXd in = share * (-(1 - rule[k].x) * attenuation).exp(),
                       to_epidermis = share * (-rule[k].x * attenuation).exp();
        auto row = result.row(part * static_cast<Index>(rule.size()) + static_cast<Index>(k));
        row = in.transpose() * meets_air.middleRows(first, count) +
              to_epidermis.transpose() * meets_epidermis.middleRows(first, count);
        row[2] += 1 - in.sum() - to_epidermis.sum();
      }
    }
    return result;
  }

 private:
  double mu(Index i) const {
    return i < upper_ ? chain_.directions(kUpper).mu[i] : chain_.directions(kLower).mu[i - upper_];
  }

  /// Shares of a ray that start at a boundary which are absorbed about each depth. Their sum is exact.
  RowVectorXd absorption_by_depth(Index i) const {
    const std::vector<QuadratureNode>& rule = depth_rule();
    RowVectorXd shares(static_cast<Index>(rule.size()));
    // Relative to the first depth: beyond it everything may underflow.
    for (size_t k = 0; k < rule.size(); ++k)
      shares[static_cast<Index>(k)] = rule[k].weight * std::exp(-attenuation_[i] * (rule[k].x - rule[0].x));
    return shares * (-std::expm1(-attenuation_[i]) / shares.sum());
  }

  /// Shares of isotropic light that move inward, or outward, along each node.
  VectorXd isotropic_shares() const {
    VectorXd shares(all_);
    shares << chain_.directions(kUpper).weight / (2 * chain_.directions(kUpper).weight.sum()),
        chain_.directions(kLower).weight / (2 * chain_.directions(kLower).weight.sum());
    return shares;
  }

  const Tissue& tissue_;
  Chain chain_;
  VectorXd axes_;        ///< cosines inside the epidermis of the directions outside
  MatrixXd directions_;  ///< lobe of the epidermis, from its nodes toward these
  Epidermis top_, bottom_;
  MatrixXd inner_, back_;
  Index upper_, all_;
  VectorXd attenuation_, kept_;
  MatrixXd through_, system_;
};

void append(const MatrixXd& values, Index first, Index count, ByDepth& to) {
  to.resize(static_cast<size_t>(count));
  for (Index i = 0; i < count; ++i) {
    const VectorXd column = values.col(first + i);
    to[static_cast<size_t>(i)].insert(to[static_cast<size_t>(i)].end(), column.begin(), column.end());
  }
}

}  // namespace

SolvedExcitation solve_excitation(const Tissue& tissue, std::span<const double> sines, int nodes) {
  Mesophyll mesophyll(tissue, sines, nodes);
  SolvedExcitation result;
  for (const auto& [above, weight] : positions(tissue, 2 * nodes)) {
    check_stop();
    mesophyll.place(above);
    for (const bool from_below : {false, true}) {
      const MatrixXd absorbed = weight * mesophyll.absorbed(from_below).transpose();
      append(absorbed, 0, absorbed.cols(), result.absorbed[from_below]);
    }
  }
  return result;
}

SolvedEmission solve_emission(const Tissue& tissue, std::span<const double> sines, int nodes) {
  Mesophyll mesophyll(tissue, sines, nodes);
  const auto ways = static_cast<Index>(sines.size());
  const double n = tissue.n_cuticle(), per_steradian = 1 / (2 * std::numbers::pi * n * n);
  ByDepth shares, toward[2];
  for (const Position& position : positions(tissue, 2 * nodes)) {
    check_stop();
    mesophyll.place(position.above);
    const MatrixXd emitted = mesophyll.emitted(), densities = per_steradian * emitted.rightCols(2 * ways);
    append(emitted, 0, 3, shares);
    for (const bool below : {false, true}) append(densities, below ? ways : 0, ways, toward[below]);
  }
  return {{shares[0], shares[1]}, shares[2], {std::move(toward[0]), std::move(toward[1])}};
}

}  // namespace frond::leaf
