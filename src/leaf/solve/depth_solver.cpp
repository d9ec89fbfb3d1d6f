#include "leaf/solve/depth_solver.h"

#include <cmath>
#include <map>
#include <numbers>

#include "core/parallel.h"
#include "leaf/solve/epidermis.h"
#include "leaf/solve/quadrature.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

}  // namespace

DepthSolver::DepthSolver(const Chain& chain, std::span<const double> theta_deg)
    : mu_above_(chain.directions(kUpper).mu), mu_below_(chain.directions(kLower).mu) {
  const Epidermis top = eliminate(chain, kAdaxial, kUpper), bottom = eliminate(chain, kAbaxial, kLower);
  back_above_ = top.back, out_above_ = top.out, back_below_ = bottom.back, out_below_ = bottom.out;

  inner_ = eliminate_air_space(chain);

  const Tissue& tissue = chain.tissue();
  const Lobe& lobe = *tissue.lobe(0, false, true);
  std::map<std::pair<bool, double>, size_t> known;
  for (const double theta : theta_deg) {
    const bool is_above = theta <= 90;
    const double from_normal = is_above ? theta : 180 - theta;
    const double mu = from_normal == 90 ? 0 : std::cos(from_normal * std::numbers::pi / 180);
    const Crossing surface = fresnel(mu, 1 / tissue.n_cuticle());
    const auto [place, is_new] = known.emplace(std::pair(is_above, surface.cos_t), entrances_.size());
    if (is_new) {
      const RowVectorXd all_ways = spread(chain, lobe, surface.cos_t) * (is_above ? top : bottom).inward;
      const Index inward = all_ways.size() - 1;
      entrances_.push_back({is_above, all_ways.head(inward), all_ways[inward]});
    }
    rays_.push_back({surface.reflectance, place->second});
  }
}

void DepthSolver::add(const Tissue& tissue, double above, double weight, std::vector<Outcome>& sums) const {
  double upper_depth = tissue.optical_depth[kUpper], lower_depth = tissue.optical_depth[kLower];
  if (tissue.air_space_moves) upper_depth *= above, lower_depth *= 1 - above;
  const Index upper = mu_above_.size(), lower = mu_below_.size();
  VectorXd kept(upper + lower);
  for (Index i = 0; i < upper; ++i) kept[i] = survival(upper_depth, mu_above_[i], tissue.sieve_and_detour);
  for (Index i = 0; i < lower; ++i) kept[upper + i] = survival(lower_depth, mu_below_[i], tissue.sieve_and_detour);
  // A ray that enters a part crosses it, meets the air space, and crosses a part toward an epidermis.
  const MatrixXd crossed = kept.asDiagonal() * inner_ * kept.asDiagonal();
  MatrixXd system(upper + lower, upper + lower), exits(upper + lower, 2);
  system.leftCols(upper).noalias() = -crossed.leftCols(upper) * back_above_;
  system.rightCols(lower).noalias() = -crossed.rightCols(lower) * back_below_;
  system.diagonal().array() += 1;
  exits.col(0).noalias() = crossed.leftCols(upper) * out_above_;
  exits.col(1).noalias() = crossed.rightCols(lower) * out_below_;
  const MatrixXd leaves = Eigen::PartialPivLU<MatrixXd>(system).solve(exits);
  for (size_t i = 0; i < entrances_.size(); ++i) {
    const Entrance& in = entrances_[i];
    for (const bool is_above : {true, false}) {
      // Upside down, a unifacial leaf is the same with 1 - p for the air space's position p.
      if (is_above != in.is_above && !tissue.air_space_moves) continue;
      const Eigen::RowVector2d out = is_above ? Eigen::RowVector2d(in.inward * leaves.topRows(upper))
                                              : Eigen::RowVector2d(in.inward * leaves.bottomRows(lower));
      sums[i].back += weight * (in.back + out[is_above ? 0 : 1]), sums[i].across += weight * out[is_above ? 1 : 0];
    }
  }
}

// Mean over the air space's position p: grazing rays make the integrand behave like p ln p at both ends, which the
// change of variable p = s^2 (3 - 2 s) removes. Each position stands for its mirror image, so half of them suffice.
std::vector<Shares> DepthSolver::solve(const Tissue& tissue, int places) const {
  std::vector<Outcome> outcomes(entrances_.size());
  if (!tissue.air_space_moves) add(tissue, 1, 1, outcomes);
  if (tissue.air_space_moves)
    for (const auto& [s, weight] : gauss_legendre(places)) {
      constexpr double kMiddle = 0.5, kRounding = 1e-12;
      if (s > kMiddle + kRounding) break;
      check_stop();
      const double is_own_mirror = s > kMiddle - kRounding ? 0.5 : 1;
      add(tissue, s * s * (3 - 2 * s), is_own_mirror * weight * 6 * s * (1 - s), outcomes);
    }
  std::vector<Shares> result;
  for (const auto& [reflectance, entrance] : rays_) {
    const double enters = 1 - reflectance;
    result.push_back({reflectance, enters * outcomes[entrance].back, enters * outcomes[entrance].across});
  }
  return result;
}

}  // namespace frond::leaf
