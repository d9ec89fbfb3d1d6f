#include "leaf/fit/fit_problem.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace frond::leaf {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Pair = OpticsSurface::Pair;

FitRows::FitRows(const FitRequest& request) {
  for (const LeafMeasurement& m : request.measurements) {
    const auto place = std::ranges::find(theta_deg, m.theta_deg);
    const auto angle = static_cast<size_t>(place - theta_deg.begin());
    if (place == theta_deg.end()) theta_deg.push_back(m.theta_deg);
    rows.push_back({angle, m.lambda_nm, OpticsSurface::weights(m.lambda_nm),
                    specific_depths(request.absorption_tables, m.lambda_nm), m.r, m.t});
  }
}

FitRows FitRows::thinned(size_t most) const {
  FitRows result = *this;
  const size_t step = (rows.size() + most - 1) / std::max<size_t>(most, 1);
  if (step <= 1) return result;
  result.rows.clear();
  for (size_t i = step / 2; i < rows.size(); i += step) result.rows.push_back(rows[i]);
  return result;
}

std::vector<size_t> FitRows::spread(size_t most) const {
  std::vector<size_t> order(rows.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [this](size_t i) { return std::pair(rows[i].angle, rows[i].lambda_nm); });
  const size_t step = (rows.size() + most - 1) / most;
  std::vector<size_t> chosen;
  for (size_t i = 0; i < order.size(); ++i) {
    const auto angle = [&](size_t k) { return rows[order[k]].angle; };
    const bool is_end = i == 0 || i + 1 == order.size() || angle(i - 1) != angle(i) || angle(i) != angle(i + 1);
    if (i % step == 0 || is_end) chosen.push_back(order[i]);
  }
  return chosen;
}

std::vector<Pair> FitRows::filled(const std::vector<size_t>& chosen, const std::vector<Pair>& solved,
                                  const OpticsSurface& surface, const Constituents& amounts) const {
  std::vector<Pair> result;
  for (const FitRow& row : rows)
    result.push_back(surface.sum(row.angle, row.weights, OpticsSurface::terms(depth_of(amounts, row.specific)).value));
  std::vector<Pair> difference;
  for (size_t i = 0; i < chosen.size(); ++i)
    difference.push_back({solved[i].r - result[chosen[i]].r, solved[i].t - result[chosen[i]].t});
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto place = [this](size_t k) { return std::pair(rows[k].angle, rows[k].lambda_nm); };
    const auto above = std::ranges::lower_bound(chosen, place(i), {}, place);
    const auto high = static_cast<size_t>(above - chosen.begin()), low = high == 0 ? 0 : high - 1;
    const double from = rows[chosen[low]].lambda_nm, width = rows[chosen[high]].lambda_nm - from;
    // The ends of each angle are chosen, so both neighbours have this row's angle, unless it is one of them.
    const double t = rows[chosen[low]].angle == rows[i].angle && width > 0 ? (rows[i].lambda_nm - from) / width : 1;
    result[i].r += std::lerp(difference[low].r, difference[high].r, t);
    result[i].t += std::lerp(difference[low].t, difference[high].t, t);
  }
  return result;
}

Index FitRows::values() const {
  Index count = 0;
  for (const FitRow& row : rows) count += (row.r ? 1 : 0) + (row.t ? 1 : 0);
  return count;
}

double FitRows::step_nm() const {
  const auto nm = std::ranges::minmax(rows, {}, &FitRow::lambda_nm);
  const double steps = static_cast<double>(rows.size()) / static_cast<double>(theta_deg.size()) - 1;
  return std::max(nm.max.lambda_nm - nm.min.lambda_nm, 1.0) / std::max(steps, 1.0);
}

FitProblem::FitProblem(const FitRequest& request, const LeafSpace& space, const FitRows& rows)
    : request_(request),
      space_(space),
      rows_(rows),
      prior_(used_prior(request)),
      weight_(static_cast<double>(request.measurements.size()) / static_cast<double>(rows.rows.size())) {
  for (Index i = 0; i < space.count(); ++i)
    if (space.variable(i).is_structure()) structural_.push_back(i);
  if (prior_) prior_variance_ = prior_->variance(rows.step_nm() / weight_);
}

VectorXd FitProblem::structure_residuals(const VectorXd& logs) const {
  if (!prior_) return {};
  const std::vector<double> at = prior_coordinates(space_.at(logs));
  VectorXd residuals = VectorXd::Zero(static_cast<Index>(at.size()));
  // A number that is given has no coordinate to be expected.
  for (size_t i = 0; i < at.size(); ++i)
    if (std::ranges::find(space_.free(), prior_numbers()[i]) != space_.free().end())
      residuals[static_cast<Index>(i)] = (at[i] - prior_->mean[i]) / prior_->deviation[i];
  return residuals;
}

MatrixXd FitProblem::structure_slopes(const VectorXd& logs) const {
  constexpr double kStep = 1e-5;
  const VectorXd here = structure_residuals(logs);
  MatrixXd slopes(here.size(), space_.count());
  for (Index i = 0; i < space_.count(); ++i) {
    VectorXd moved = logs;
    const double step = logs[i] + kStep <= space_.high(i) ? kStep : -kStep;
    moved[i] += step;
    slopes.col(i) = (structure_residuals(moved) - here) / step;
  }
  return slopes;
}

MatrixXd FitProblem::prior_information(const VectorXd& logs) const {
  const MatrixXd slopes = structure_slopes(logs);
  return slopes.transpose() * slopes;
}

OpticsSurface FitProblem::surface(const SurfaceExpansion& expansion, const VectorXd& logs) const {
  OpticsSurface result = expansion.base;
  for (size_t k = 0; k < expansion.slopes.size(); ++k)
    result.add(logs[structural_[k]] - expansion.at[structural_[k]], expansion.slopes[k]);
  return result;
}

std::vector<Pair> FitProblem::values(const SurfaceExpansion& expansion, const VectorXd& logs) const {
  const OpticsSurface here = surface(expansion, logs);
  const Constituents amounts = amounts_of(space_.at(logs));
  std::vector<Pair> result;
  result.reserve(rows_.rows.size());
  for (const FitRow& row : rows_.rows)
    result.push_back(here.sum(row.angle, row.weights, OpticsSurface::terms(depth_of(amounts, row.specific)).value));
  return result;
}

double FitProblem::cost(const std::vector<Pair>& values, const VectorXd& logs) const {
  const auto square = [](double x) { return x * x; };
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const FitRow& row = rows_.rows[i];
    if (row.r) sum += square(Huber::value(on_background(values[i].r, values[i].t, request_.background) - *row.r));
    if (row.t) sum += square(Huber::value(values[i].t - *row.t));
  }
  sum *= weight_;
  for (Index i = 0; i < space_.count(); ++i) sum += square(prior(i, logs));
  return sum + prior_variance_ * structure_residuals(logs).squaredNorm();
}

double FitProblem::cost(const SurfaceExpansion& expansion, const VectorXd& logs) const {
  return cost(values(expansion, logs), logs);
}

template <class Visit>
void FitProblem::for_each_row(const SurfaceExpansion& expansion, const VectorXd& logs, const Visit& visit) const {
  constexpr double kSmall = 1e-5;
  const OpticsSurface here = surface(expansion, logs);
  const TissueParams p = space_.at(logs);
  const Constituents amounts = amounts_of(p);
  const Index count = space_.count();
  // Derivatives of the amounts by the parameters of the chemistry.
  MatrixXd changes = MatrixXd::Zero(amounts.size(), count);
  for (Index i = 0; i < count; ++i) {
    const LeafNumber& variable = space_.variable(i);
    if (variable.is_structure()) continue;
    const TissueParams moved = space_.with(p, variable, variable.value(p) * std::exp(kSmall));
    changes.col(i) = (amounts_of(moved) - amounts) / kSmall;
  }
  VectorXd by_r(count), by_t(count), by_depth(count);
  for (size_t i = 0; i < rows_.rows.size(); ++i) {
    const FitRow& row = rows_.rows[i];
    const OpticsSurface::Terms terms = OpticsSurface::terms(depth_of(amounts, row.specific));
    Pair value = here.sum(row.angle, row.weights, terms.value);
    const Pair slope = here.sum(row.angle, row.weights, terms.slope);
    if (!expansion.corrections.empty()) value.r += expansion.corrections[i].r, value.t += expansion.corrections[i].t;
    by_depth.noalias() = changes.transpose() * row.specific.matrix();
    by_r = slope.r * by_depth, by_t = slope.t * by_depth;
    for (size_t k = 0; k < expansion.slopes.size(); ++k) {
      const Pair change = expansion.slopes[k].sum(row.angle, row.weights, terms.value);
      by_r[structural_[k]] = change.r, by_t[structural_[k]] = change.t;
    }
    if (const double background = request_.background; background > 0) {
      const double again = background / (1 - value.r * background);
      by_r = (1 + value.t * value.t * again * again) * by_r + 2 * value.t * again * by_t;
      value.r = on_background(value.r, value.t, background);
    }
    visit(row, value, by_r, by_t);
  }
}

FitProblem::Normal FitProblem::normal(const SurfaceExpansion& expansion, const VectorXd& logs) const {
  const Index count = space_.count();
  Normal n{0, VectorXd::Zero(count), MatrixXd::Zero(count, count)};
  const auto take = [&n](double residual, const VectorXd& derivatives) {
    const double value = Huber::value(residual), slope = Huber::slope(residual);
    n.cost += value * value;
    n.gradient += value * slope * derivatives;
    n.product.selfadjointView<Eigen::Lower>().rankUpdate(derivatives, slope * slope);
  };
  for_each_row(expansion, logs, [&](const FitRow& row, const Pair& value, const VectorXd& by_r, const VectorXd& by_t) {
    if (row.r) take(value.r - *row.r, by_r);
    if (row.t) take(value.t - *row.t, by_t);
  });
  n.cost *= weight_, n.gradient *= weight_, n.product *= weight_;
  for (Index i = 0; i < count; ++i) {
    const double residual = prior(i, logs);
    n.cost += residual * residual, n.gradient[i] += residual * expectation();
    n.product(i, i) += expectation() * expectation();
  }
  if (prior_) {
    const VectorXd residuals = structure_residuals(logs);
    const MatrixXd slopes = structure_slopes(logs);
    n.cost += prior_variance_ * residuals.squaredNorm();
    n.gradient += prior_variance_ * slopes.transpose() * residuals;
    n.product += prior_variance_ * slopes.transpose() * slopes;
  }
  return n;
}

MatrixXd FitProblem::jacobian(const SurfaceExpansion& expansion, const VectorXd& logs) const {
  MatrixXd result(rows_.values(), space_.count());
  Index at = 0;
  for_each_row(expansion, logs, [&](const FitRow& row, const Pair&, const VectorXd& by_r, const VectorXd& by_t) {
    if (row.r) result.row(at++) = by_r.transpose();
    if (row.t) result.row(at++) = by_t.transpose();
  });
  return result;
}

double FitProblem::minimise(const SurfaceExpansion& expansion, const Effort& effort, VectorXd& logs) const {
  const Index count = space_.count();
  VectorXd low(count), high(count);
  for (Index i = 0; i < count; ++i) {
    low[i] = space_.low(i), high[i] = space_.high(i);
    if (!space_.variable(i).is_structure()) continue;
    const double at = expansion.at[i], radius = effort.structure_is_free ? effort.radius : 0;
    low[i] = std::max(low[i], at - radius), high[i] = std::min(high[i], at + radius);
  }
  constexpr double kFirst = 1e-3, kLeast = 1e-9, kMost = 1e6;
  // Longest step of a logarithm. Without a limit a pigment can go to the end of its range in one step; there the leaf
  // is black in its band, the gradient almost 0, and the pigment never returns.
  constexpr double kLongest = 1;
  double damping = kFirst;
  Normal here = normal(expansion, logs);
  for (int step = 0; step < effort.most_steps && damping < kMost; ++step) {
    // A parameter at an end of its range stays there unless the sum of squares falls away from it.
    std::vector<Index> free;
    for (Index i = 0; i < count; ++i)
      if (low[i] < high[i] && !(logs[i] <= low[i] && here.gradient[i] > 0) &&
          !(logs[i] >= high[i] && here.gradient[i] < 0))
        free.push_back(i);
    if (free.empty()) break;
    MatrixXd product = here.product.selfadjointView<Eigen::Lower>();
    MatrixXd system = product(free, free);
    const VectorXd gradient = here.gradient(free);
    double gain = 0;
    for (; damping < kMost; damping *= 5) {
      MatrixXd damped = system;
      damped.diagonal() *= 1 + damping;
      const VectorXd change = damped.ldlt().solve(-gradient).cwiseMax(-kLongest).cwiseMin(kLongest);
      VectorXd there = logs;
      for (size_t k = 0; k < free.size(); ++k)
        there[free[k]] = std::clamp(logs[free[k]] + change[static_cast<Index>(k)], low[free[k]], high[free[k]]);
      Normal found = normal(expansion, there);
      if (!(found.cost < here.cost)) continue;
      gain = (here.cost - found.cost) / here.cost;
      here = std::move(found), logs = there;
      damping = std::max(kLeast, damping * 0.2);
      break;
    }
    if (gain < effort.done && damping < 1) break;
  }
  return here.cost;
}

}  // namespace frond::leaf
