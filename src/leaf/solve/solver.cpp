#include "leaf/solve/solver.h"

#include <map>
#include <numbers>

#include "leaf/solve/chain.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr size_t kFirst = Chain::kFirst, kLast = Chain::kLast;
constexpr Eigen::Index kAdaxial = 0, kAbaxial = 1;  ///< exits

/// Rays that meet the outer interface leave with the probability to be transmitted there.
Sources leaving(const Chain& chain) {
  Sources sources{.ways = 2};
  sources.up[kFirst] = MatrixXd::Zero(chain.count(kFirst), 2);
  sources.up[kFirst].col(kAdaxial) = chain.chance(kFirst, true, true);
  sources.down[kLast] = MatrixXd::Zero(chain.count(kLast), 2);
  sources.down[kLast].col(kAbaxial) = chain.chance(kLast, false, true);
  return sources;
}

/// Distribution of a lobe's rays over the nodes; division by the sum replaces the cut and conserves energy exactly.
VectorXd spread(const Lobe& lobe, double mu_axis, const Directions& to) {
  const VectorXd axis = VectorXd::Constant(1, mu_axis);
  const VectorXd row = lobe_modes(lobe.exponent(), axis, to.mu, 1)[0].row(0).transpose().cwiseProduct(to.weight);
  return row / row.sum();
}

}  // namespace

int solver_nodes(const Tissue& tissue) {
  const auto [least, most] = exponents_inside(tissue);
  constexpr double kSmooth = 1, kNarrow = 20;
  return least >= kSmooth && most <= kNarrow ? 6 : 12;
}

namespace {

/// Everything that does not depend on the depth.
class LeafSolver {
 public:
  LeafSolver(const Tissue& tissue, std::span<const double> theta_deg, int nodes)
      : chain_(tissue, nodes, 1), sources_(leaving(chain_)), solver_(chain_, 0, sources_), places_(2 * nodes) {
    const Lobe& lobe = *tissue.lobe(0, false, true);
    std::map<double, size_t> known;  // both epidermes have one index: each angle serves both sides
    for (const double theta : theta_deg) {
      const bool above = theta <= 90;
      const double from_normal = above ? theta : 180 - theta;
      const double mu = from_normal == 90 ? 0 : std::cos(from_normal * std::numbers::pi / 180);
      const Crossing surface = fresnel(mu, 1 / tissue.n_cuticle());
      const auto [row, is_new] = known.emplace(surface.cos_t, rows_.size());
      if (is_new) rows_.push_back(spread(lobe, surface.cos_t, chain_.directions(kFirst)));
      rays_.push_back({above, surface.reflectance, row->second});
    }
  }

  /// `tissue`: the constructor's, or one that differs in depth alone.
  std::vector<Shares> solve(const Tissue& tissue) const {
    const Prospects inside = solver_.solve(tissue, places_);
    std::vector<Shares> result;
    for (const auto& [above, reflectance, row] : rays_) {
      const Eigen::RowVector2d out = rows_[row].transpose() * (above ? inside.from_above : inside.from_below);
      const double enters = 1 - reflectance;
      result.push_back(
          {reflectance, enters * out[above ? kAdaxial : kAbaxial], enters * out[above ? kAbaxial : kAdaxial]});
    }
    return result;
  }

 private:
  /// A ray that meets the leaf.
  struct Ray {
    bool above;
    double reflectance;
    size_t row;
  };

  Chain chain_;
  Sources sources_;
  ModeSolver solver_;
  int places_;
  std::vector<VectorXd> rows_;  ///< distribution over the nodes of rays that enter
  std::vector<Ray> rays_;       ///< [angle]
};

}  // namespace

std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg, int nodes) {
  return LeafSolver(tissue, theta_deg, nodes).solve(tissue);
}

std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg) {
  return solve(tissue, theta_deg, solver_nodes(tissue));
}

std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg) {
  return solve_depths(tissues, theta_deg, solver_nodes(tissues[0]));
}

std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg,
                                              int nodes) {
  const LeafSolver solver(tissues[0], theta_deg, nodes);
  std::vector<std::vector<Shares>> result;
  for (const Tissue& tissue : tissues) result.push_back(solver.solve(tissue));
  return result;
}

}  // namespace frond::leaf
