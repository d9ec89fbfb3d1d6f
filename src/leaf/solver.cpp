#include "leaf/solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "leaf/azimuth.h"
#include "leaf/fresnel.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr size_t kFirst = 1, kLast = 5;  ///< media of the leaf
/// Columns of what awaits a ray: to leave by the adaxial, by the abaxial side.
using Outcome = Eigen::MatrixX2d;
constexpr Index kAdaxial = 0, kAbaxial = 1;

/// Directions in one medium: cosines and their quadrature weights. Node i is the same k = n sin theta in every medium
/// that has it.
struct Directions {
  VectorXd mu, weight;
};

/// A part of the range of k: cosines from `from` to `to` in the medium of index n.
struct Segment {
  double n, from, to;
};

/// Ascending in k, cut at each medium's index, where its critical angles are.
std::vector<Segment> segments(const Tissue& tissue) {
  std::vector<double> indices(tissue.n.begin(), tissue.n.end());
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<Segment> result;
  double below = 0;
  for (const double n : indices) {
    const double widest = std::sqrt(1 - below * below / (n * n));
    constexpr double kGrading[] = {1, 0.3, 0.05, 0};
    for (size_t i = 0; i + 1 < std::size(kGrading); ++i)
      result.push_back({n, kGrading[i + 1] * widest, kGrading[i] * widest});
    below = n;
  }
  return result;
}

Directions directions_in(double n, std::span<const Segment> parts, std::span<const QuadratureNode> rule) {
  std::vector<double> mu, weight;
  for (const Segment& part : parts) {
    if (part.n > n) break;
    const double ratio2 = part.n * part.n / (n * n), width = part.to - part.from;
    for (const auto& [x, w] : rule) {
      const double mu_own = part.to - x * width;
      // 1 - ratio2 (1 - mu_own^2), but for grazing directions between almost equal indices, where that leaves no
      // digits.
      mu.push_back(std::sqrt((n - part.n) * (n + part.n) + part.n * part.n * mu_own * mu_own) / n);
      weight.push_back(w * width * ratio2 * mu_own / mu.back());
    }
  }
  const auto count = static_cast<Index>(mu.size());
  return {VectorXd::Map(mu.data(), count), VectorXd::Map(weight.data(), count)};
}

/// Where a lobe sends rays among the nodes; the cut is made good by the sum, which keeps energy exactly.
VectorXd spread(const AzimuthMean& lobe, double mu_axis, const Directions& to) {
  VectorXd row(to.mu.size());
  for (Index i = 0; i < row.size(); ++i) row[i] = lobe(mu_axis, to.mu[i]) * to.weight[i];
  return row / row.sum();
}

/// The chain over one leaf's states, except for what the media absorb.
class Chain {
 public:
  Chain(const Tissue& tissue, int nodes) : tissue_(tissue) {
    const std::vector<Segment> parts = segments(tissue);
    const std::vector<QuadratureNode> rule = gauss_legendre(nodes);
    for (size_t m = 0; m < Tissue::kMedia; ++m) directions_[m] = directions_in(tissue.n[m], parts, rule);
    for (size_t m = kFirst; m <= kLast; ++m)
      for (const bool up : {false, true})
        for (const bool refracts : {false, true}) branch_[m][up][refracts] = make_branch(m, up, refracts);
  }

  const Directions& directions(size_t medium) const { return directions_[medium]; }
  /// States in `medium` going up or down, to states in the medium that the branch leads to. Not for ways out.
  const MatrixXd& branch(size_t medium, bool up, bool refracts) const { return branch_[medium][up][refracts]; }
  /// Chance to pass the outer interface from inside.
  VectorXd exit(size_t medium) const { return VectorXd::Ones(count(medium)) - reflectance(medium, medium == kFirst); }

  Index count(size_t medium) const { return directions_[medium].mu.size(); }

 private:
  static size_t next(size_t medium, bool up) { return up ? medium - 1 : medium + 1; }

  VectorXd reflectance(size_t medium, bool up) const {
    const double eta = tissue_.n[medium] / tissue_.n[next(medium, up)];
    return directions_[medium].mu.unaryExpr([eta](double mu) { return fresnel(mu, eta).reflectance; });
  }

  /// Rows: axes that are nodes of `medium`.
  const MatrixXd& kernel(const Lobe& lobe, size_t medium) {
    const auto key = std::make_pair(lobe.exponent(), tissue_.n[medium]);
    if (const auto known = kernels_.find(key); known != kernels_.end()) return known->second;
    const Directions& d = directions_[medium];
    const AzimuthMean mean(lobe.exponent());
    MatrixXd matrix(d.mu.size(), d.mu.size());
    for (Index i = 0; i < d.mu.size(); ++i)
      for (Index j = 0; j <= i; ++j) matrix(i, j) = matrix(j, i) = mean(d.mu[i], d.mu[j]);
    matrix *= d.weight.asDiagonal();
    matrix.array().colwise() /= matrix.rowwise().sum().array().eval();
    return kernels_[key] = matrix;
  }

  /// Nodes at which both interfaces of a medium reflect everything, and change no direction.
  Index held_for_ever(size_t medium) const {
    const bool smooth = !tissue_.lobes[medium - 1][true][false] && !tissue_.lobes[medium][false][false];
    return smooth ? std::max(Index{0}, count(medium) - std::max(count(medium - 1), count(medium + 1))) : 0;
  }

  MatrixXd make_branch(size_t medium, bool up, bool refracts) {
    const size_t to = refracts ? next(medium, up) : medium;
    if (to < kFirst || to > kLast) return {};
    const Lobe* lobe = tissue_.lobes[up ? medium - 1 : medium][up][refracts];
    const VectorXd r = reflectance(medium, up);
    VectorXd chance = refracts ? VectorXd(VectorXd::Ones(r.size()) - r) : r;
    // Nothing would ever end a ray there. None gets there, but the system needs a solution for it too.
    if (!refracts) chance.tail(held_for_ever(medium)).setZero();
    // A node without a counterpart in the next medium is past the critical angle and never gets there.
    const Index common = std::min(count(medium), count(to));
    MatrixXd matrix = MatrixXd::Zero(count(medium), count(to));
    if (lobe)
      matrix.topRows(common) = kernel(*lobe, to).topRows(common);
    else
      matrix.topLeftCorner(common, common).setIdentity();
    return chance.asDiagonal() * matrix;
  }

  const Tissue& tissue_;
  std::array<Directions, Tissue::kMedia> directions_;
  std::array<std::array<std::array<MatrixXd, 2>, 2>, Tissue::kMedia> branch_;
  std::map<std::pair<double, double>, MatrixXd> kernels_;
};

/// What awaits a ray that has just entered the leaf, by its node in the epidermis.
struct Prospects {
  Outcome from_above, from_below;
};

/// Eliminates media from the top. Throughout, what awaits an upward ray is P (what awaits a downward one) + q, with all
/// that lies above accounted for.
Prospects prospects(const Chain& chain, const std::array<VectorXd, Tissue::kMedia>& survival_of) {
  const auto step = [&](size_t m, bool up, bool refracts) -> MatrixXd {
    return survival_of[m].asDiagonal() * chain.branch(m, up, refracts);
  };
  const auto leave = [&](size_t m, Index column) {
    Outcome out = Outcome::Zero(chain.count(m), 2);
    out.col(column) = survival_of[m].cwiseProduct(chain.exit(m));
    return out;
  };
  std::array<MatrixXd, Tissue::kMedia> x;
  std::array<Outcome, Tissue::kMedia> y;
  MatrixXd p = step(kFirst, true, false);
  Outcome q = leave(kFirst, kAdaxial);
  for (size_t m = kFirst; m < kLast; ++m) {
    const MatrixXd down = step(m, false, false), up = step(m + 1, true, true);
    const Eigen::PartialPivLU<MatrixXd> lu(MatrixXd::Identity(p.rows(), p.rows()) - down * p);
    x[m] = lu.solve(step(m, false, true));
    y[m] = lu.solve(down * q);
    q = up * (p * y[m] + q);
    p = step(m + 1, true, false) + up * (p * x[m]);
  }
  const MatrixXd down = step(kLast, false, false);
  Outcome downward =
      (MatrixXd::Identity(p.rows(), p.rows()) - down * p).partialPivLu().solve(down * q + leave(kLast, kAbaxial));
  const Outcome upward = p * downward + q;
  for (size_t m = kLast; m-- > kFirst;) downward = Outcome(x[m] * downward + y[m]);
  return {downward, upward};
}

std::array<VectorXd, Tissue::kMedia> survivals(const Tissue& tissue, const Chain& chain, double above) {
  std::array<VectorXd, Tissue::kMedia> result;
  for (size_t m = kFirst; m <= kLast; ++m) {
    double depth = tissue.optical_depth[m];
    if (tissue.air_space_moves && m == 2) depth *= above;
    if (tissue.air_space_moves && m == 4) depth *= 1 - above;
    result[m] =
        chain.directions(m).mu.unaryExpr([&](double mu) { return survival(depth, mu, tissue.sieve_and_detour); });
  }
  return result;
}

Outcome swapped(const Outcome& outcome) { return outcome.rowwise().reverse(); }

/// Mean over the places of the air space. Grazing rays make the integrand behave like p ln p at both ends: the change
/// of variable p = s^2 (3 - 2 s) takes that away. Such a leaf is the same seen from below, with 1 - p for p: so half of
/// the places tell the whole.
Prospects mean_prospects(const Tissue& tissue, const Chain& chain, int places) {
  if (!tissue.air_space_moves) return prospects(chain, survivals(tissue, chain, 1));
  Outcome sum = Outcome::Zero(chain.count(kFirst), 2);
  for (const auto& [s, weight] : gauss_legendre(places)) {
    constexpr double kMiddle = 0.5, kRounding = 1e-12;
    if (s > kMiddle + kRounding) break;
    const Prospects part = prospects(chain, survivals(tissue, chain, s * s * (3 - 2 * s)));
    const double w = weight * 6 * s * (1 - s) * (s > kMiddle - kRounding ? 0.5 : 1);  // the middle is its own mirror
    sum += w * (part.from_above + swapped(part.from_below));
  }
  return {sum, swapped(sum)};
}

}  // namespace

int solver_nodes(const Tissue& tissue) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (size_t m = kFirst; m <= kLast; ++m)
    for (const bool up : {false, true})
      for (const bool refracts : {false, true})
        if (const Lobe* lobe = tissue.lobes[up ? m - 1 : m][up][refracts]) {
          least = std::min(least, lobe->exponent());
          most = std::max(most, lobe->exponent());
        }
  constexpr double kSmooth = 1, kNarrow = 20;
  return least >= kSmooth && most <= kNarrow ? 6 : 12;
}

namespace {

/// All that does not depend on the depth.
class LeafSolver {
 public:
  LeafSolver(const Tissue& tissue, std::span<const double> theta_deg, int nodes)
      : chain_(tissue, nodes), places_(2 * nodes) {
    const AzimuthMean lobe(tissue.lobes[0][false][true]->exponent());
    std::map<double, size_t> known;  // both epidermes are of one index: each angle serves both sides
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

  /// The tissue that it was made for, or one that differs in depth.
  std::vector<Shares> solve(const Tissue& tissue) const {
    const Prospects inside = mean_prospects(tissue, chain_, places_);
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
  int places_;
  std::vector<VectorXd> rows_;  ///< where rays that enter go
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
  const LeafSolver solver(tissues[0], theta_deg, solver_nodes(tissues[0]));
  std::vector<std::vector<Shares>> result;
  for (const Tissue& tissue : tissues) result.push_back(solver.solve(tissue));
  return result;
}

}  // namespace frond::leaf
