#include "leaf/fit/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "leaf/fit/fit_search.h"
#include "leaf/tissue/area_content.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Correlation of neighbouring residuals along the spectrum.
double neighbour_correlation(const std::vector<double>& residuals) {
  double product = 0, square = 0;
  for (size_t i = 0; i + 1 < residuals.size(); ++i) product += residuals[i] * residuals[i + 1];
  for (const double x : residuals) square += x * x;
  return square > 0 ? std::clamp(product / square, 0.0, 0.99) : 0;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x * x;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Sets errors, correlations, parameters and contents of a result that has its `params` and `fitted`.
void compute_statistics(const FitRequest& request, const FitRows& rows, const FoundLeaf& found, FitResult& result) {
  const LeafSpace& space = *found.space;
  const FitProblem problem(request, space, rows);
  std::vector<double> r, t;
  for (size_t i = 0; i < request.measurements.size(); ++i) {
    const LeafMeasurement& measurement = request.measurements[i];
    FitResult::Fitted& fitted = result.fitted[i];
    if (measurement.r) r.push_back(fitted.r - *measurement.r);
    if (measurement.t) t.push_back(fitted.t - *measurement.t);
    fitted.is_outlier = (measurement.r && std::abs(fitted.r - *measurement.r) > Huber::kFar) ||
                        (measurement.t && std::abs(fitted.t - *measurement.t) > Huber::kFar);
  }
  if (!r.empty()) result.rmse_r = root_mean_square(r);
  if (!t.empty()) result.rmse_t = root_mean_square(t);
  const double rho = (static_cast<double>(r.size()) * neighbour_correlation(r) +
                      static_cast<double>(t.size()) * neighbour_correlation(t)) /
                     static_cast<double>(r.size() + t.size());
  r.insert(r.end(), t.begin(), t.end());
  result.rmse = root_mean_square(r);

  const Index n = space.count();
  const double spare = std::max(1.0, static_cast<double>(rows.values() - n));
  const double error = std::max(request.least_error, result.rmse * std::sqrt(static_cast<double>(r.size()) / spare));
  constexpr double kLeastCorrelation = 1e-3;
  result.reach_nm = -rows.step_nm() / std::log(std::max(rho, kLeastCorrelation));
  // R alone is fitted closer than R and T, by a wrong leaf: the error is not below that of the prior's leaves.
  const double variance = std::max(error * error * (1 + rho) / (1 - rho), problem.prior_variance());
  const MatrixXd j = problem.jacobian(found.expansion, found.logs);
  // The almost flat prior makes the error of a parameter that the measurements do not determine large but finite.
  constexpr double kVague = 10;
  MatrixXd information = j.transpose() * j / variance;
  for (Index i = 0; i < n; ++i) {
    const double expected = request.has_prior ? problem.expectation() / error : 0;
    information(i, i) += expected * expected + 1 / (kVague * kVague);
  }
  if (result.prior) information += problem.prior_information(found.logs);
  const MatrixXd covariance = information.ldlt().solve(MatrixXd::Identity(n, n));
  result.correlations.assign(static_cast<size_t>(n), std::vector<double>(static_cast<size_t>(n)));
  for (Index a = 0; a < n; ++a)
    for (Index b = 0; b < n; ++b)
      result.correlations[static_cast<size_t>(a)][static_cast<size_t>(b)] =
          covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
  for (const LeafNumber* v : space.numbers()) {
    FittedNumber number{v, v->value(result.params)};
    const auto place = std::ranges::find(space.free(), v);
    number.is_fixed = place == space.free().end();
    if (!number.is_fixed) {
      const auto i = static_cast<Index>(place - space.free().begin());
      number.relative_error = std::sqrt(covariance(i, i));
      constexpr double kNear = 1.02;
      const auto of_prior = result.prior ? result.prior->relative_deviation(*v, number.value) : std::nullopt;
      constexpr double kHalf = 0.7;  // of the information
      number.is_of_prior = of_prior && number.relative_error > kHalf * *of_prior;
      number.is_at_bound = number.value < v->fit_range.min * kNear || number.value > v->fit_range.max / kNear;
    }
    result.numbers.push_back(number);
  }
  // Contents per area, with the errors of linearised products.
  constexpr double kStep = 1e-4;
  for (const AreaContent& content : area_contents()) {
    const double value = area_content(result.params, content);
    if (!(value > 0)) continue;
    VectorXd slope(n);
    for (Index i = 0; i < n; ++i) {
      const LeafNumber& v = space.variable(i);
      const TissueParams moved = space.with(result.params, v, v.value(result.params) * std::exp(kStep));
      slope[i] = std::log(area_content(moved, content) / value) / kStep;
    }
    result.contents.push_back(
        {content.name, content.unit, value, std::sqrt(std::max(0.0, slope.dot(covariance * slope)))});
  }
}

}  // namespace

std::optional<double> rmse_between(const FitRequest& request, const FitResult& result, const Interval& nm) {
  std::vector<double> residuals;
  for (size_t i = 0; i < request.measurements.size(); ++i) {
    const LeafMeasurement& measurement = request.measurements[i];
    if (!nm.contains(measurement.lambda_nm)) continue;
    if (measurement.r) residuals.push_back(result.fitted[i].r - *measurement.r);
    if (measurement.t) residuals.push_back(result.fitted[i].t - *measurement.t);
  }
  if (residuals.empty()) return {};
  return root_mean_square(residuals);
}

FitResult fit_leaf(const FitRequest& given, const ThreadPool& pool, FitCache* cache) {
  FitCache own;
  FitRequest request = given;
  const StructurePrior* prior = used_prior(given);
  // The prior is of this kind of leaf; R alone does not tell the kinds apart.
  if (prior) request.structure = Structure::bifacial, request.sieve = true;
  const FitRows rows(request);
  const FoundLeaf found = search_leaf(request, rows, pool, cache ? *cache : own);
  FitResult result;
  result.prior = prior;
  result.params = found.space->at(found.logs), result.specimen = &found.space->specimen();
  for (const auto& [r, t] : found.solved) result.fitted.push_back({on_background(r, t, request.background), t, false});
  compute_statistics(request, rows, found, result);
  result.misfits = misfit_bands(request, result);
  return result;
}

}  // namespace frond::leaf
