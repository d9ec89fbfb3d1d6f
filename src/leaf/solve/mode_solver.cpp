#include "core/parallel.h"
#include "leaf/solve/chain.h"
#include "leaf/solve/quadrature.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr size_t kFirst = Chain::kFirst, kLast = Chain::kLast;

/// The tissue turned upside down.
MatrixXd swapped(const MatrixXd& outcome) {
  const Index half = outcome.cols() / 2;
  MatrixXd result(outcome.rows(), outcome.cols());
  result << outcome.rightCols(half), outcome.leftCols(half);
  return result;
}

}  // namespace

ModeSolver::ModeSolver(const Chain& chain, size_t mode, const Sources& sources) : chain_(chain), sources_(sources) {
  for (size_t m = kFirst; m <= kLast; ++m)
    for (const bool up : {false, true}) {
      reflect_[m][up] = chain.branch(mode, m, up, false);
      if (up ? m > kFirst : m < kLast) refract_[m][up] = chain.branch(mode, m, up, true);
    }
}

/// `above`: share of the mesophyll above the air space, where that moves.
ModeSolver::Survivals ModeSolver::survivals(const Tissue& tissue, double above) const {
  Survivals result;
  for (size_t m = kFirst; m <= kLast; ++m) {
    double depth = tissue.optical_depth[m];
    if (tissue.air_space_moves && m == 2) depth *= above;
    if (tissue.air_space_moves && m == 4) depth *= 1 - above;
    result[m] =
        chain_.directions(m).mu.unaryExpr([&](double mu) { return survival(depth, mu, tissue.sieve_and_detour); });
  }
  return result;
}

MatrixXd ModeSolver::source(const Survivals& survival, size_t medium, bool up) const {
  const MatrixXd& s = (up ? sources_.up : sources_.down)[medium];
  if (s.size() == 0) return MatrixXd::Zero(chain_.count(medium), sources_.ways);
  return survival[medium].asDiagonal() * s;
}

/// Eliminates media from the top. Invariant: the value of an upward ray is P (value of a downward ray) + q, with all
/// media above eliminated.
Prospects ModeSolver::solve(const Survivals& survival) const {
  std::array<MatrixXd, Tissue::kMedia> x, y;
  MatrixXd p = survival[kFirst].asDiagonal() * reflect_[kFirst][true];
  MatrixXd q = source(survival, kFirst, true);
  for (size_t m = kFirst; m <= kLast; ++m) {
    const MatrixXd down = survival[m].asDiagonal() * reflect_[m][false];
    const Eigen::PartialPivLU<MatrixXd> lu(MatrixXd::Identity(p.rows(), p.rows()) - down * p);
    y[m] = lu.solve(down * q + source(survival, m, false));
    if (m == kLast) break;
    x[m] = lu.solve(survival[m].asDiagonal() * refract_[m][false]);
    const MatrixXd up = survival[m + 1].asDiagonal() * refract_[m + 1][true];
    q = up * (p * y[m] + q) + source(survival, m + 1, true);
    p = survival[m + 1].asDiagonal() * reflect_[m + 1][true] + up * (p * x[m]).eval();
  }
  MatrixXd downward = y[kLast];
  const MatrixXd upward = p * downward + q;
  for (size_t m = kLast; m-- > kFirst;) downward = (x[m] * downward + y[m]).eval();
  return {downward, upward};
}

// Mean over the air space's position p: grazing rays make the integrand behave like p ln p at both ends, which the
// change of variable p = s^2 (3 - 2 s) removes. Turned upside down the leaf is the same with 1 - p for p, so half of
// the positions suffice.
Prospects ModeSolver::solve(const Tissue& tissue, int places) const {
  if (!tissue.air_space_moves) return solve(survivals(tissue, 1));
  MatrixXd sum = MatrixXd::Zero(chain_.count(kFirst), sources_.ways);
  for (const auto& [s, weight] : gauss_legendre(places)) {
    constexpr double kMiddle = 0.5, kRounding = 1e-12;
    if (s > kMiddle + kRounding) break;
    check_stop();
    const Prospects part = solve(survivals(tissue, s * s * (3 - 2 * s)));
    const double w =
        weight * 6 * s * (1 - s) * (s > kMiddle - kRounding ? 0.5 : 1);  // the middle is its own mirror image
    sum += w * (part.from_above + swapped(part.from_below));
  }
  return {sum, swapped(sum)};
}

}  // namespace frond::leaf
