#include "leaf/solve/chain.h"

#include <algorithm>
#include <limits>

#include "core/parallel.h"
#include "leaf/solve/azimuth.h"
#include "leaf/solve/lobe_mean.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A segment of the range of k: cosines from `from` to `to` in the medium of index n.
struct Segment {
  double n, from, to;
  int nodes;
};

/// Number of nodes for a segment that carries this share of the light in its medium, where it is diffuse.
int nodes_for(double share, int most) {
  constexpr double kSteps[] = {0.1, 0.02, 0.002};
  int nodes = most;
  for (const double step : kSteps)
    if (share < step) --nodes;
  return std::max(nodes, 1);
}

/// Segments ascending in k, cut at each medium's index, where its critical angles are.
std::vector<Segment> segments(const Tissue& tissue, const NodeRule& rule) {
  std::vector<double> indices(tissue.n.begin(), tissue.n.end());
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  constexpr double kGraded[] = {1, 0.3, 0.05, 0}, kHardly[] = {1, 0.3, 0}, kWhole[] = {1, 0};
  constexpr double kLittle = 0.02, kSome = 0.2;  // shares of the light
  std::vector<Segment> result;
  double below = 0;
  for (const double n : indices) {
    const double share = 1 - below * below / (n * n), widest = std::sqrt(share);
    const std::span<const double> grading = !rule.by_flux || share > kSome ? std::span<const double>(kGraded)
                                            : share > kLittle              ? std::span<const double>(kHardly)
                                                                           : std::span<const double>(kWhole);
    for (size_t i = 0; i + 1 < grading.size(); ++i) {
      const double to = grading[i], from = grading[i + 1];
      const int nodes = rule.by_flux ? nodes_for(share * (to * to - from * from), rule.nodes) : rule.nodes;
      result.push_back({n, from * widest, to * widest, nodes});
    }
    below = n;
  }
  return result;
}

/// Rules of quadrature by their number of nodes. The small ones are made once for all chains.
const std::vector<QuadratureNode>& rule_of(int nodes, std::vector<QuadratureNode>& own) {
  static const std::vector<std::vector<QuadratureNode>> small = [] {
    constexpr int kSmall = 12;
    std::vector<std::vector<QuadratureNode>> rules;
    for (int n = 0; n <= kSmall; ++n) rules.push_back(gauss_legendre(n));
    return rules;
  }();
  if (static_cast<size_t>(nodes) < small.size()) return small[static_cast<size_t>(nodes)];
  if (own.size() != static_cast<size_t>(nodes)) own = gauss_legendre(nodes);
  return own;
}

Directions directions_in(double n, std::span<const Segment> parts) {
  std::vector<double> mu, weight;
  std::vector<QuadratureNode> own;
  for (const Segment& part : parts) {
    if (part.n > n) break;
    const double ratio2 = part.n * part.n / (n * n), width = part.to - part.from;
    for (const auto& [x, w] : rule_of(part.nodes, own)) {
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

}  // namespace

std::vector<MatrixXd> lobe_modes(double exponent, const VectorXd& axes, const VectorXd& directions, size_t modes) {
  const AzimuthModes lobe(exponent);
  std::vector<MatrixXd> result(modes, MatrixXd(axes.size(), directions.size()));
  std::vector<double> column(modes);
  const bool symmetric = &axes == &directions;
  for (Index i = 0; i < axes.size(); ++i) {
    check_stop();
    for (Index j = 0; j < (symmetric ? i + 1 : directions.size()); ++j) {
      lobe(axes[i], directions[j], column);
      for (size_t m = 0; m < modes; ++m) {
        result[m](i, j) = column[m];
        if (symmetric) result[m](j, i) = column[m];
      }
    }
  }
  return result;
}

Chain::Chain(const Tissue& tissue, const NodeRule& rule, size_t modes, LobeMeans* means)
    : tissue_(tissue), means_(means) {
  const std::vector<Segment> parts = segments(tissue, rule);
  for (size_t m = 0; m < Tissue::kMedia; ++m) directions_[m] = directions_in(tissue.n[m], parts);
  for (size_t m = kFirst; m <= kLast; ++m)
    for (const bool up : {false, true})
      for (const bool refracts : {false, true}) {
        const size_t to = refracts ? next(m, up) : m;
        if (const Lobe* l = lobe(m, up, refracts); l && to >= kFirst && to <= kLast) make_kernel(*l, to, modes);
      }
}

void Chain::make_kernel(const Lobe& lobe, size_t medium, size_t modes) {
  const auto [place, is_new] = kernels_.try_emplace({lobe.exponent(), tissue_.n[medium]});
  if (!is_new) return;
  const Directions& d = directions_[medium];
  Kernel& kernel = place->second;
  kernel.shares =
      means_ ? std::vector{means_->get(lobe.exponent()).matrix(d.mu)} : lobe_modes(lobe.exponent(), d.mu, d.mu, modes);
  kernel.kept = kernel.shares[0] * d.weight;
  for (MatrixXd& shares : kernel.shares)
    shares = kernel.kept.cwiseInverse().asDiagonal() * shares * d.weight.asDiagonal();
}

VectorXd Chain::probability(size_t medium, bool up, bool refracts) const {
  const double eta = tissue_.n[medium] / tissue_.n[next(medium, up)];
  return directions_[medium].mu.unaryExpr([eta, refracts](double mu) {
    const double reflectance = fresnel(mu, eta).reflectance;
    return refracts ? 1 - reflectance : reflectance;
  });
}

// A node without a counterpart in the next medium is past the critical angle: its transmittance is 0.
MatrixXd Chain::branch(size_t mode, size_t medium, bool up, bool refracts) const {
  const size_t to = refracts ? next(medium, up) : medium;
  const Index common = std::min(count(medium), count(to));
  MatrixXd matrix = MatrixXd::Zero(count(medium), count(to));
  if (const Lobe* l = lobe(medium, up, refracts))
    matrix.topRows(common) = kernel(*l, to).shares[mode].topRows(common);
  else
    matrix.topLeftCorner(common, common).setIdentity();
  VectorXd taken = probability(medium, up, refracts);
  // A ray in such a state would never end. No ray reaches it, but the linear system requires a row for it that is not
  // singular.
  if (!refracts) taken.tail(totally_reflected(medium)).setZero();
  return taken.asDiagonal() * matrix;
}

Index Chain::totally_reflected(size_t medium) const {
  const bool smooth = !lobe(medium, true, false) && !lobe(medium, false, false);
  return smooth ? std::max(Index{0}, count(medium) - std::max(count(medium - 1), count(medium + 1))) : 0;
}

MatrixXd Chain::branch_density(const MatrixXd& toward, size_t medium, bool up, bool refracts) const {
  const size_t to = refracts ? next(medium, up) : medium;
  const Index common = std::min(count(medium), count(to));
  const VectorXd scale = probability(medium, up, refracts)
                             .head(common)
                             .cwiseQuotient(kernel(*lobe(medium, up, refracts), to).kept.head(common));
  MatrixXd matrix = MatrixXd::Zero(count(medium), toward.cols());
  matrix.topRows(common) = scale.asDiagonal() * toward.topRows(common);
  return matrix;
}

Interval exponents_inside(const Tissue& tissue) {
  Interval range{std::numeric_limits<double>::infinity(), 0};
  for (size_t m = Chain::kFirst; m <= Chain::kLast; ++m)
    for (const bool up : {false, true})
      for (const bool refracts : {false, true})
        if (const Lobe* lobe = tissue.lobe(up ? m - 1 : m, up, refracts)) {
          range.min = std::min(range.min, lobe->exponent());
          range.max = std::max(range.max, lobe->exponent());
        }
  return range;
}

}  // namespace frond::leaf
