#include "leaf/plates/plate_leaf.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <list>
#include <mutex>
#include <numbers>

#include "leaf/tissue/constants.h"
#include "leaf/tissue/leaf_numbers.h"

namespace frond::leaf {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

const PlateNumber* find(std::span<const PlateNumber> numbers, std::string_view name) {
  const auto found = std::ranges::find(numbers, name, &PlateNumber::name);
  return found == numbers.end() ? nullptr : &*found;
}

/// Transmittance of a smooth interface, from air to index n, for unpolarised light that is uniform within an angle of
/// the normal (Stern 1964; Allen 1973, equations A3 to A13).
double interface_transmittance(double theta_deg, double n) {
  const double n2 = n * n, plus = n2 + 1, minus = n2 - 1, a = (n + 1) * (n + 1) / 2, k = -minus * minus / 4;
  const double s2 = std::pow(std::sin(theta_deg * std::numbers::pi / 180), 2), x = s2 - plus / 2;
  const double b = std::sqrt(std::max(0.0, x * x + k)) - x;
  const auto polarised = [&](double y) { return k * k / (6 * y * y * y) + k / y - y / 2; };
  const double s = polarised(b) - polarised(a);
  const auto inner = [&](double y) { return 2 * plus * y - minus * minus; };
  const double p = -2 * n2 * (b - a) / (plus * plus) - 2 * n2 * plus * std::log(b / a) / (minus * minus) +
                   n2 * (1 / b - 1 / a) / 2 +
                   16 * n2 * n2 * (n2 * n2 + 1) * std::log(inner(b) / inner(a)) / (plus * plus * plus * minus * minus) +
                   16 * n2 * n2 * n2 * (1 / inner(b) - 1 / inner(a)) / (plus * plus * plus);
  return (s + p) / (2 * s2);
}

/// Transmittance of a layer of optical depth k for isotropic light: 2 E3(k).
double layer_transmittance(double k) { return k > 0 ? (1 - k) * std::exp(-k) - k * k * std::expint(-k) : 1; }

/// R and T of a plate, or of a stack.
struct Slab {
  double r, t;
};

/// A plate, lit through an interface of transmittance `entering`; that of its interfaces from inside is `leaving`.
Slab plate(double entering, double leaving, double layer) {
  const double back = 1 - leaving, t = entering * layer * leaving / (1 - back * back * layer * layer);
  return {1 - entering + back * layer * t, t};
}

/// A stack of `count` equal plates under diffuse light (Stokes 1862); `count` need not be whole.
Slab stack(const Slab& one, double count) {
  const auto [r, t] = one;
  constexpr double kAbsorbs = 1e-12;  // less than this: the limit of the formula
  if (1 - r - t < kAbsorbs) {
    const double through = t / (t + (1 - t) * count);
    return {1 - through, through};
  }
  const double d = std::sqrt((1 + r + t) * (1 + r - t) * (1 - r + t) * (1 - r - t));
  const double a = (1 + r * r - t * t + d) / (2 * r), b = std::pow((1 - r * r + t * t + d) / (2 * t), count);
  const double below = a * a * b * b - 1;
  return {a * (b * b - 1) / below, b * (a * a - 1) / below};
}

/// Transmittances of the interfaces of plates at one node.
struct Interfaces {
  double first;     ///< into the first plate
  double entering;  ///< into each further one
  double leaving;   ///< out of each
};

/// Returns those of all nodes, in the order of prospect_nodes().
const std::vector<Interfaces>& interfaces() {
  constexpr double kFirst_deg = 40;
  static const std::vector<Interfaces> all = [] {
    std::vector<Interfaces> made;
    for (const ProspectNode& node : prospect_nodes()) {
      const double n = node.refractive_index, entering = interface_transmittance(90, n);
      made.push_back({interface_transmittance(kFirst_deg, n), entering, entering / (n * n)});
    }
    return made;
  }();
  return all;
}

Slab shares_at(const PlateLeaf& leaf, size_t node) {
  const ProspectConstants& specific = prospect_nodes()[node].specific;
  double depth = 0;
  for (size_t i = 1; i < leaf.values.size(); ++i)
    depth += leaf.values[i] * plate_numbers()[i].scale * specific.*plate_numbers()[i].specific;
  const auto [into_first, entering, leaving] = interfaces()[node];
  const double layer = layer_transmittance(depth / leaf.plates());
  const Slab first = plate(into_first, leaving, layer), each = plate(entering, leaving, layer);
  const Slab rest = stack(each, leaf.plates() - 1);
  const double between = 1 - rest.r * each.r;
  return {first.r + first.t * rest.r * each.t / between, first.t * rest.t / between};
}

/// A measured R or T.
struct PlateRow {
  size_t node;  ///< the nearest one: nodes are 1 nm apart
  bool is_t;
  double value;
  double background;  ///< of R
};

std::vector<PlateRow> plate_rows(std::span<const LeafMeasurement> measurements, double background) {
  constexpr double kMost_deg = 20;
  const std::span<const ProspectNode> nodes = prospect_nodes();
  std::vector<PlateRow> rows;
  for (const LeafMeasurement& m : measurements) {
    const double nm = std::round(m.lambda_nm), theta = std::min(m.theta_deg, 180 - m.theta_deg);
    if (theta > kMost_deg || nm < nodes.front().nm || nm > nodes.back().nm) continue;
    const auto node = static_cast<size_t>(nm - nodes.front().nm);
    if (m.r) rows.push_back({node, false, *m.r, background});
    if (m.t) rows.push_back({node, true, *m.t, 0});
  }
  return rows;
}

VectorXd plate_residuals(std::span<const PlateRow> rows, const VectorXd& values) {
  const PlateLeaf leaf{{values.begin(), values.end()}};
  VectorXd residuals(static_cast<Index>(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    const Slab shares = shares_at(leaf, rows[i].node);
    residuals[static_cast<Index>(i)] =
        (rows[i].is_t ? shares.t : on_background(shares.r, shares.t, rows[i].background)) - rows[i].value;
  }
  return residuals;
}

/// Method of Levenberg and Marquardt within the ranges of the numbers, from `values`; returns the sum of squares.
double minimise(std::span<const PlateRow> rows, const VectorXd& low, const VectorXd& high, VectorXd& values) {
  constexpr int kMostSteps = 60;
  constexpr double kDone = 1e-7, kMostDamping = 1e8, kStep = 1e-6;
  const Index count = values.size();
  VectorXd residuals = plate_residuals(rows, values);
  double damping = 1e-2;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    MatrixXd slopes(residuals.size(), count);
    for (Index i = 0; i < count; ++i) {
      VectorXd moved = values;
      moved[i] += kStep * (high[i] - low[i]);  // the formulae hold somewhat beyond the range, too
      slopes.col(i) = (plate_residuals(rows, moved) - residuals) / (moved[i] - values[i]);
    }
    const VectorXd gradient = slopes.transpose() * residuals;
    // A number at an end of its range stays there unless the sum of squares falls away from it.
    std::vector<Index> free;
    for (Index i = 0; i < count; ++i)
      if (!(values[i] <= low[i] && gradient[i] > 0) && !(values[i] >= high[i] && gradient[i] < 0)) free.push_back(i);
    if (free.empty()) break;
    const MatrixXd product = slopes(Eigen::all, free).transpose() * slopes(Eigen::all, free);
    double gain = 0;
    for (; damping < kMostDamping; damping *= 4) {
      MatrixXd damped = product;
      damped.diagonal() *= 1 + damping;
      VectorXd there = values;
      there(free) -= damped.ldlt().solve(gradient(free));
      there = there.cwiseMax(low).cwiseMin(high);
      const VectorXd found = plate_residuals(rows, there);
      if (!(found.squaredNorm() < residuals.squaredNorm())) continue;
      gain = 1 - found.squaredNorm() / residuals.squaredNorm();
      residuals = found, values = there;
      damping = std::max(damping / 10, 1e-9);
      break;
    }
    if (gain < kDone) break;
  }
  return residuals.squaredNorm();
}

NearestWalk fit(const PlateLeaf& leaf) {
  FitRequest request;
  for (const LeafMeasurement& m : plate_spectra(leaf))
    if (std::fmod(m.lambda_nm, 10) == 0 && m.lambda_nm >= 400) request.measurements.push_back(m);
  const FitResult result = fit_leaf(request, ThreadPool(1));
  NearestWalk walk{result.params, result.rmse, 0, 0};
  for (size_t i = 0; i < request.measurements.size(); ++i) {
    const LeafMeasurement& m = request.measurements[i];
    const double off = std::max(std::abs(result.fitted[i].r - *m.r), std::abs(result.fitted[i].t - *m.t));
    if (off > walk.largest) walk.largest = off, walk.largest_nm = m.lambda_nm;
  }
  return walk;
}

}  // namespace

std::span<const PlateNumber> plate_numbers() {
  static const std::vector<PlateNumber> numbers = [] {
    std::vector<PlateNumber> all{{"N",
                                  "",
                                  {1, 10},
                                  "PROSPECT-D's leaf structure: the number of plates, about 1 to 3. N and the contents "
                                  "describe the whole tissue, in place of its other parameters (docs/leaf_models.md).",
                                  true,
                                  nullptr,
                                  1}};
    for (const LeafNumber& n : kLeafNumbers) {
      const AreaContent& content = n.content;
      if (!n.prospect || content.prospect_symbol.empty() || find(all, content.prospect_symbol)) continue;
      // Contents of leaves are at most this many times the typical one; a content without a unit is at most about 1.
      constexpr double kMost = 15;
      const double typical = content.unit.typical > 0 ? content.unit.typical : 1;
      all.push_back(
          {content.prospect_symbol,
           content.unit.name,
           {0, kMost * typical},
           fmt::format("PROSPECT-D's content of {}{}.", content.name, content.is_in_all ? "" : "; by default 0"),
           content.is_in_all,
           n.prospect,
           1 / (content.unit.per_kg_per_m2 * content.kg_per_m3)});
    }
    return all;
  }();
  return numbers;
}

const PlateNumber* find_plate_number(std::string_view name) { return find(plate_numbers(), name); }

std::optional<PlateFit> fit_plates(std::span<const LeafMeasurement> measurements, double background) {
  const std::vector<PlateRow> rows = plate_rows(measurements, background);
  const std::span<const PlateNumber> numbers = plate_numbers();
  if (rows.size() < numbers.size()) return {};
  const auto count = static_cast<Index>(numbers.size());
  VectorXd low(count), high(count);
  for (Index i = 0; i < count; ++i) {
    const Interval& range = numbers[static_cast<size_t>(i)].range;
    low[i] = range.min, high[i] = range.max;
  }
  // Plates, and contents as shares of the largest ones.
  constexpr std::pair<double, double> kStarts[] = {{1.5, 0.02}, {2.5, 0.01}, {1.2, 0.06}};
  PlateFit best{{}, HUGE_VAL};
  for (const auto& [plates, share] : kStarts) {
    VectorXd values = share * high;
    values[0] = plates;
    const double rmse = std::sqrt(minimise(rows, low, high, values) / static_cast<double>(rows.size()));
    constexpr double kSame = 1e-3;
    const bool is_same = std::abs(rmse - best.rmse) < kSame * rmse;
    if (rmse < best.rmse) best = {{{values.begin(), values.end()}}, rmse};
    if (is_same) break;
  }
  return best;
}

std::vector<LeafMeasurement> plate_spectra(const PlateLeaf& leaf) {
  constexpr double kTheta_deg = 8;
  std::vector<LeafMeasurement> spectra;
  for (size_t i = 0; i < prospect_nodes().size(); ++i) {
    const auto [r, t] = shares_at(leaf, i);
    if (spectra.empty()) spectra.push_back({kConstantsRange_nm.min, kTheta_deg, r, t});
    spectra.push_back({prospect_nodes()[i].nm, kTheta_deg, r, t});
  }
  return spectra;
}

const NearestWalk& nearest_walk(const PlateLeaf& leaf) {
  static std::mutex mutex;
  static std::list<std::pair<PlateLeaf, NearestWalk>> known;  // references remain valid
  const std::scoped_lock lock(mutex);
  for (const auto& [of, walk] : known)
    if (of == leaf) return walk;
  return known.emplace_back(leaf, fit(leaf)).second;
}

}  // namespace frond::leaf
