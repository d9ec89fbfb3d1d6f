#include "leaf/table/reciprocal_modes.h"

#include <Eigen/Core>

#include "core/parallel.h"
#include "leaf/table/exit_weights.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Grid = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// One of the four series: the side that is lit and the side that light leaves by, as in LeafModes.
struct Route {
  bool from_below, crosses;
  Route reversed() const { return {from_below != crosses, crosses}; }
};
constexpr Route kAbove{false, false}, kBelow{true, false}, kThrough{false, true};

VectorXd inner_cosines(const std::vector<double>& sines, double index) {
  VectorXd mu(static_cast<Index>(sines.size()));
  for (Index i = 0; i < mu.size(); ++i) {
    const double sine = sines[static_cast<size_t>(i)] / index;
    mu[i] = std::sqrt(1 - sine * sine);
  }
  return mu;
}

Grid grid(const LeafModes& modes, const Route& route, size_t mode) {
  const auto side = static_cast<Index>(modes.sines().size());
  return {modes.series(route.from_below, route.crosses)[mode].data(), side, side};
}

/// f / ((1 - F_i) (1 - F_o)) of one mode, the mean over exchanged directions; rows are incident directions.
MatrixXd symmetrised_mode(const LeafModes& modes, const VectorXd& inner, const Route& route, size_t mode) {
  const auto over = inner.cwiseInverse().asDiagonal();
  const MatrixXd there = grid(modes, route, mode) * over, back = grid(modes, route.reversed(), mode) * over;
  return (there + back.transpose()) / 2;
}

VectorXd as_vector(const std::vector<double>& v) {
  return Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size()));
}

/// Share of the light that has come in that leaves again, by direction: those above the leaf, then those below.
VectorXd outgoing(const LeafModes& modes, double index, size_t cells) {
  const VectorXd weight = as_vector(exit_weights(index, cells, Measure::over_inner_cosine));
  VectorXd share(2 * weight.size());
  share << (grid(modes, kAbove, 0) + grid(modes, kThrough, 0)) * weight,
      (grid(modes, kBelow, 0) + grid(modes, kThrough.reversed(), 0)) * weight;
  return share;
}

/// Solves d_i sum over j of k_ij d_j = share_i for d, where k is close to symmetric up to factors of its columns.
std::optional<VectorXd> scaling(const MatrixXd& k, const VectorXd& share) {
  constexpr int kMostSteps = 1000;
  constexpr double kNothing = 1e-12, kDone = 1e-12, kGoodEnough = 1e-9;
  VectorXd d = VectorXd::Ones(share.size());
  if (share.cwiseAbs().maxCoeff() < kNothing) return d;  // black: nothing to scale
  double off = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    check_stop();
    const VectorXd sum = k * d;
    if (!(sum.minCoeff() > 0 && share.minCoeff() > 0)) return {};
    off = (d.cwiseProduct(sum).cwiseQuotient(share).array() - 1).abs().maxCoeff();
    if (off < kDone) return d;
    d = (d.cwiseProduct(share).cwiseQuotient(sum)).cwiseSqrt();
  }
  if (off < kGoodEnough) return d;
  return {};
}

LeafModes::Grid to_row_major(const MatrixXd& matrix) {
  LeafModes::Grid values(static_cast<size_t>(matrix.size()));
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(values.data(), matrix.rows(),
                                                                                     matrix.cols()) = matrix;
  return values;
}

std::optional<LeafModes> make_reciprocal(const LeafModes& modes, double index, size_t cells) {
  const VectorXd inner = inner_cosines(modes.sines(), index);
  const VectorXd weight = as_vector(exit_weights(index, cells, Measure::plain));
  const Index side = weight.size();
  MatrixXd k(2 * side, 2 * side);
  const MatrixXd through = symmetrised_mode(modes, inner, kThrough, 0);
  k << symmetrised_mode(modes, inner, kAbove, 0), through, through.transpose(),
      symmetrised_mode(modes, inner, kBelow, 0);
  const auto d = scaling(k * weight.replicate(2, 1).asDiagonal(), outgoing(modes, index, cells));
  if (!d) return {};
  LeafModes result(modes.sines());
  const auto scaled = [&](const Route& route, size_t mode) -> MatrixXd {
    const auto of = [&](bool below) { return d->segment(below ? side : 0, side); };
    return of(route.from_below).asDiagonal() * symmetrised_mode(modes, inner, route, mode) *
           of(route.reversed().from_below).asDiagonal();
  };
  for (const Route& route : {kAbove, kBelow, kThrough, kThrough.reversed()})
    for (size_t m = 0; m < modes.series(route.from_below, route.crosses).size(); ++m)
      result.series(route.from_below, route.crosses).push_back(to_row_major(scaled(route, m)));
  return result;
}

}  // namespace

std::optional<ModeTable> make_reciprocal(const ModeTable& spectrum) {
  ModeTable result{.cells = spectrum.cells, .index = spectrum.index, .error = spectrum.error, .is_reciprocal = true};
  for (size_t c = 0; c < spectrum.modes.size(); ++c) {
    auto modes = make_reciprocal(spectrum.modes[c], spectrum.index[c], static_cast<size_t>(spectrum.cells));
    if (!modes) return {};
    result.modes.push_back(std::move(*modes));
  }
  return result;
}

}  // namespace frond::leaf
