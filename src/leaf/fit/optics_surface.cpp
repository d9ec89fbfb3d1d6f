#include "leaf/fit/optics_surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "leaf/fit/bare_leaf.h"
#include "leaf/solve/lobe_mean.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/constants.h"

namespace frond::leaf {
namespace {

constexpr size_t kWavelengths = OpticsSurface::kWavelengths, kTerms = OpticsSurface::kTerms;

// The polynomials are Chebyshev's in x = log(depth + kOffset), in which R and T are smooth from no absorption to
// complete absorption.
constexpr double kOffset = 0.1, kDeepest = 40;

/// Position of a depth in [-1, 1].
double to_unit_coordinate(double depth) {
  static const double first = std::log(kOffset), width = std::log(kDeepest + kOffset) - first;
  return 2 * (std::log(depth + kOffset) - first) / width - 1;
}
double depth_at(double place) {
  const double first = std::log(kOffset), width = std::log(kDeepest + kOffset) - first;
  return std::max(0.0, std::exp(first + (place + 1) / 2 * width) - kOffset);
}

/// Chebyshev's nodes, and the weights that give each coefficient of the series from the values there.
struct Waves {
  std::array<double, kTerms> place;
  std::array<std::array<double, kTerms>, kTerms> weight;
};
const Waves& waves() {
  static const Waves all = [] {
    constexpr auto kCount = static_cast<double>(kTerms);
    Waves result;
    for (size_t d = 0; d < kTerms; ++d) {
      const double angle = (static_cast<double>(d) + 0.5) * std::numbers::pi / kCount;
      result.place[d] = std::cos(angle);
      for (size_t k = 0; k < kTerms; ++k)
        result.weight[k][d] = std::cos(static_cast<double>(k) * angle) * (k == 0 ? 1 : 2) / kCount;
    }
    return result;
  }();
  return all;
}

/// Nodes of the interpolation over wavelengths.
constexpr std::array<double, kWavelengths> kNodes_nm{400, 550, 1000, 1950, 2500};

/// The functions of the refractive indices that the interpolation reproduces. The antidermal wall's index follows the
/// mesophyll's.
Eigen::Vector<double, kWavelengths> basis(double lambda_nm) {
  const Constants c = constants_at(lambda_nm);
  const double cuticle = c.n_cuticle - 1.47, mesophyll = c.n_mesophyll - 1.4;
  return {1, cuticle, mesophyll, cuticle * cuticle, cuticle * mesophyll};
}

}  // namespace

OpticsSurface::Weights OpticsSurface::weights(double lambda_nm) {
  using Matrix = Eigen::Matrix<double, kWavelengths, kWavelengths>;
  static const Matrix inverse = [] {
    Matrix at_nodes;
    for (size_t w = 0; w < kWavelengths; ++w) at_nodes.col(static_cast<Eigen::Index>(w)) = basis(kNodes_nm[w]);
    return Matrix(at_nodes.inverse());
  }();
  const Eigen::Vector<double, kWavelengths> found = inverse * basis(lambda_nm);
  Weights result;
  std::ranges::copy(found, result.begin());
  return result;
}

OpticsSurface::Terms OpticsSurface::terms(double depth) {
  const double x = std::min(to_unit_coordinate(std::min(depth, kDeepest)), 1.0);
  static const double scale = 2 / (std::log(kDeepest + kOffset) - std::log(kOffset));
  const double by_depth = depth < kDeepest ? scale / (depth + kOffset) : 0;
  Terms result;
  result.value[0] = 1, result.value[1] = x;
  result.slope[0] = 0, result.slope[1] = by_depth;
  double second = 2 * x, before = 1;  // polynomials of the second kind, of which the derivatives consist
  for (size_t k = 2; k < kTerms; ++k) {
    result.value[k] = 2 * x * result.value[k - 1] - result.value[k - 2];
    result.slope[k] = static_cast<double>(k) * second * by_depth;
    before = std::exchange(second, 2 * x * second - before);
  }
  return result;
}

OpticsSurface::OpticsSurface(const TissueParams& params, std::span<const double> theta_deg, const NodeRule& rule,
                             LobeMeans& means)
    : series_(theta_deg.size() * kWavelengths) {
  const BareLeaf leaf(params);
  for (size_t w = 0; w < kWavelengths; ++w) {
    std::vector<Tissue> tissues;
    for (const double x : waves().place) tissues.push_back(leaf.at(kNodes_nm[w], depth_at(x)));
    const auto shares = solve_depths(tissues, theta_deg, rule, means);
    for (size_t a = 0; a < theta_deg.size(); ++a)
      for (size_t d = 0; d < kTerms; ++d) {
        const Shares& s = shares[d][a];
        const Pair value{s.surface + s.subsurface, s.transmitted};
        for (size_t k = 0; k < kTerms; ++k) {
          Pair& coefficient = series_[a * kWavelengths + w][k];
          coefficient.r += waves().weight[k][d] * value.r, coefficient.t += waves().weight[k][d] * value.t;
        }
      }
  }
}

void OpticsSurface::add(double factor, const OpticsSurface& other) {
  for (size_t i = 0; i < series_.size(); ++i)
    for (size_t k = 0; k < kTerms; ++k)
      series_[i][k].r += factor * other.series_[i][k].r, series_[i][k].t += factor * other.series_[i][k].t;
}

void OpticsSurface::scale(double factor) {
  for (auto& part : series_)
    for (Pair& coefficient : part) coefficient.r *= factor, coefficient.t *= factor;
}

}  // namespace frond::leaf
