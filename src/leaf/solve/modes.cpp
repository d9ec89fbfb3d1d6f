#include "leaf/solve/modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "leaf/solve/chain.h"
#include "leaf/solve/epidermis.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr size_t kFirst = Chain::kFirst, kLast = Chain::kLast;

/// An epidermis at the outer interface: the distribution over nodes of light that has just come in, and the density,
/// over directions that are no nodes, of light that a lobe scatters outward. Both epidermes have one index and one
/// lobe.
class Port {
 public:
  Port(const Chain& chain, const VectorXd& mu, size_t modes)
      : chain_(chain), lobes_(lobe_modes(lobe().exponent(), epidermis().mu, mu, modes)) {
    kept_ = lobes_[0].transpose() * epidermis().weight;
  }

  /// Shares: rows are the inner directions of incoming light, columns are nodes.
  MatrixXd entrance(size_t mode) const {
    return kept_.cwiseInverse().asDiagonal() * lobes_[mode].transpose() * epidermis().weight.asDiagonal();
  }

  /// Light leaves unperturbed through the outer interface, but every direction inside an epidermis is drawn from a
  /// lobe: so the event before the last one has a density toward every direction.
  Sources exits(size_t mode) const {
    const Index ways = lobes_[mode].cols();
    Sources sources{.ways = 2 * ways};
    const auto add = [&](MatrixXd& source, size_t medium, bool up, bool refracts, Index column) {
      source = MatrixXd::Zero(chain_.count(medium), sources.ways);
      source.middleCols(column, ways) = chain_.branch_density(lobes_[mode], medium, up, refracts);
    };
    add(sources.down[kFirst], kFirst, false, false, 0);
    add(sources.up[kFirst + 1], kFirst + 1, true, true, 0);
    add(sources.up[kLast], kLast, true, false, ways);
    add(sources.down[kLast - 1], kLast - 1, false, true, ways);
    return sources;
  }

 private:
  const Lobe& lobe() const { return *chain_.tissue().lobe(0, false, true); }
  const Directions& epidermis() const { return chain_.directions(kFirst); }

  const Chain& chain_;
  std::vector<MatrixXd> lobes_;  ///< [mode](node, direction)
  VectorXd kept_;
};

/// -1 for negative sines in odd modes.
VectorXd signs(std::span<const double> sines, size_t mode) {
  VectorXd result(static_cast<Index>(sines.size()));
  for (Index i = 0; i < result.size(); ++i) result[i] = mode % 2 == 1 && sines[static_cast<size_t>(i)] < 0 ? -1 : 1;
  return result;
}

LeafModes::Grid to_row_major(const MatrixXd& matrix) {
  LeafModes::Grid grid;
  for (Index i = 0; i < matrix.rows(); ++i)
    for (Index j = 0; j < matrix.cols(); ++j) grid.push_back(matrix(i, j));
  return grid;
}

/// Number of significant modes of a lobe of this exponent.
size_t most_modes(double exponent) { return static_cast<size_t>(16 + 3 * std::sqrt(exponent)); }

}  // namespace

double interface_transmittance(const Tissue& tissue, double cos_i, double cos_o) {
  const double eta = 1 / tissue.n_cuticle();
  const Crossing in = fresnel(cos_i, eta), out = fresnel(cos_o, eta);
  return (1 - in.reflectance) * (1 - out.reflectance) / out.cos_t;
}

int mode_nodes(const Tissue& tissue) {
  const auto [least, most] = exponents_inside(tissue);
  const int for_width = static_cast<int>(std::ceil(2.5 + 1.1 * std::sqrt(most)));
  return std::max(least < 1 ? 8 : 5, for_width);
}

LeafModes solve_modes(const Tissue& tissue, std::span<const double> sines, double tolerance, int nodes) {
  const size_t most = most_modes(tissue.lobe(0, false, true)->exponent());
  const Chain chain(tissue, nodes, most);
  const double n = tissue.n_cuticle();
  const Port port(chain, inner_cosines(sines, n), most);
  const auto ways = static_cast<Index>(sines.size());

  LeafModes result({sines.begin(), sines.end()});
  std::array<bool, 2> open{true, true};  // whether reflected, transmitted light has modes left
  for (size_t m = 0; m < most && (open[0] || open[1]); ++m) {
    check_stop();
    const Sources exits = port.exits(m);
    const Prospects inside = ModeSolver(chain, m, exits).solve(tissue, 2 * nodes);
    const MatrixXd entrance = port.entrance(m);
    const VectorXd sign = signs(sines, m);
    const double scale = (m == 0 ? 1 : 2) / (2 * std::numbers::pi * n * n);
    std::array<double, 2> largest{};
    std::array<std::array<MatrixXd, 2>, 2> values;
    for (const bool from_below : {false, true}) {
      const MatrixXd out = scale * sign.asDiagonal() * entrance * (from_below ? inside.from_below : inside.from_above);
      for (const bool crosses : {false, true}) {
        MatrixXd& part = values[from_below][crosses];
        part = out.middleCols(from_below != crosses ? ways : 0, ways) * sign.asDiagonal();
        largest[crosses] = std::max(largest[crosses], part.cwiseAbs().maxCoeff());
      }
    }
    for (const bool crosses : {false, true}) {
      // Each omitted mode is at most a third of the one before it.
      open[crosses] = open[crosses] && (m == 0 || largest[crosses] * std::numbers::pi > tolerance / 2);
      if (open[crosses])
        for (const bool from_below : {false, true})
          result.series(from_below, crosses).push_back(to_row_major(values[from_below][crosses]));
    }
  }
  return result;
}

}  // namespace frond::leaf
