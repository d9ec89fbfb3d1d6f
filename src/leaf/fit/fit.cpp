#include "leaf/fit/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>
#include <unsupported/Eigen/NonLinearOptimization>

#include "leaf/fit/leaf_space.h"
#include "leaf/fit/optics_surface.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/area_content.h"

namespace frond::leaf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Grade = OpticsSurface::Grade;

/// Huber's loss: returns the residual whose square is quadratic up to `kFar` and linear beyond it.
struct Huber {
  static constexpr double kFar = 0.06;
  static double value(double x) {
    const double a = std::abs(x);
    return a <= kFar ? x : std::copysign(std::sqrt(2 * kFar * a - kFar * kFar), x);
  }
  static double slope(double x) {
    const double a = std::abs(x);
    return a <= kFar ? 1 : kFar / std::sqrt(2 * kFar * a - kFar * kFar);
  }
};

/// Residuals between measurements and the leaves of a space.
class Problem {
 public:
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Problem(const FitRequest& request, const LeafSpace& space, Grade grade, bool structure_is_free,
          const ThreadPool& pool)
      : request_(request), space_(space), grade_(grade), structure_is_free_(structure_is_free), pool_(pool) {
    for (const LeafMeasurement& r : request.measurements) {
      const auto place = std::ranges::find(theta_deg_, r.theta_deg);
      angle_.push_back(static_cast<size_t>(place - theta_deg_.begin()));
      if (place == theta_deg_.end()) theta_deg_.push_back(r.theta_deg);
      first_nm_ = std::min(first_nm_, r.lambda_nm), last_nm_ = std::max(last_nm_, r.lambda_nm);
      rows_ += (r.r ? 1 : 0) + (r.t ? 1 : 0);
    }
  }

  int inputs() const { return static_cast<int>(space_.count()); }
  int values() const { return static_cast<int>(rows_ + space_.count()); }
  Index rows() const { return rows_; }

  /// Residuals of the measurements, followed by those of the prior.
  int operator()(const VectorXd& q, VectorXd& f) const {
    const TissueParams p = space_.at(q);
    const OpticsSurface& surface = surface_of(p, grade_);
    Index row = 0;
    for (size_t i = 0; i < request_.measurements.size(); ++i) {
      const LeafMeasurement& measurement = request_.measurements[i];
      const auto v = surface.at(angle_[i], measurement.lambda_nm, depth_of(p, measurement.lambda_nm));
      if (measurement.r) f[row++] = Huber::value(v.r - *measurement.r);
      if (measurement.t) f[row++] = Huber::value(v.t - *measurement.t);
    }
    for (Index i = 0; i < space_.count(); ++i)
      f[row++] = expectation() * (space_.log_at(i, q[i]) - std::log(space_.origin().*space_.variable(i).number));
    return 0;
  }

  int df(const VectorXd& q, MatrixXd& j) const {
    MatrixXd by_log(rows_, space_.count());
    jacobian(space_.at(q), by_log, true);
    j.setZero();
    for (Index i = 0; i < space_.count(); ++i) {
      const double slope = space_.slope(i, q[i]);
      j.col(i).head(rows_) = by_log.col(i) * slope;
      j(rows_ + i, i) = expectation() * slope;
      if (!structure_is_free_ && space_.variable(i).is_structure) j.col(i).setZero();
    }
    return 0;
  }

  /// Derivatives of the model's R and T, or of the residuals that least squares use, with respect to the logarithms of
  /// the free parameters.
  void jacobian(const TissueParams& p, MatrixXd& j, bool of_residuals) const {
    constexpr double kStep = 0.02, kSmall = 1e-5;
    // R and T are smooth in the structure's parameters, so coarse tables suffice here.
    const OpticsSurface &surface = surface_of(p, grade_), &coarse = surface_of(p, Grade::coarse);
    for (Index c = 0; c < space_.count(); ++c) {
      const FitVariable& variable = space_.variable(c);
      if (variable.is_structure && !structure_is_free_) {
        j.col(c).setZero();
        continue;
      }
      const double step = variable.is_structure ? kStep : kSmall;
      const TissueParams moved = space_.with(p, variable, p.*variable.number * std::exp(step));
      const OpticsSurface& other = variable.is_structure ? surface_of(moved, Grade::coarse) : surface;
      Index row = 0;
      for (size_t i = 0; i < request_.measurements.size(); ++i) {
        const LeafMeasurement& measurement = request_.measurements[i];
        const double depth = depth_of(p, measurement.lambda_nm);
        const auto v = surface.at(angle_[i], measurement.lambda_nm, depth);
        double r, t;
        if (variable.is_structure) {
          const auto here = coarse.at(angle_[i], measurement.lambda_nm, depth),
                     there = other.at(angle_[i], measurement.lambda_nm, depth);
          r = (there.r - here.r) / step, t = (there.t - here.t) / step;
        } else {
          const double slope = (depth_of(moved, measurement.lambda_nm) - depth) / step;
          r = v.r_slope * slope, t = v.t_slope * slope;
        }
        if (measurement.r) j(row++, c) = r * (of_residuals ? Huber::slope(v.r - *measurement.r) : 1);
        if (measurement.t) j(row++, c) = t * (of_residuals ? Huber::slope(v.t - *measurement.t) : 1);
      }
    }
  }

  /// Weight of a logarithm's distance from the prior, in units of reflectance.
  double expectation() const { return request_.has_prior ? 0.03 : 3e-4; }

 private:
  using Structural = std::array<double, 5>;

  const OpticsSurface& surface_of(const TissueParams& p, Grade grade) const {
    auto& surface = surfaces_[{
        grade, {p.epidermis_aspect, p.spongy_aspect, p.palisade_aspect, p.spongy_share, p.cuticle_refractivity}}];
    if (!surface) surface = std::make_unique<OpticsSurface>(p, theta_deg_, first_nm_, last_nm_, grade, pool_);
    return *surface;
  }

  const FitRequest& request_;
  const LeafSpace& space_;
  Grade grade_;
  bool structure_is_free_;
  const ThreadPool& pool_;
  std::vector<double> theta_deg_;
  std::vector<size_t> angle_;  ///< of each measurement
  double first_nm_ = kConstantsRange_nm.max, last_nm_ = kConstantsRange_nm.min;
  Index rows_ = 0;
  mutable std::map<std::pair<Grade, Structural>, std::unique_ptr<OpticsSurface>> surfaces_;
};

/// End of a search.
struct Candidate {
  std::unique_ptr<LeafSpace> space;
  VectorXd q;
  double cost;  ///< sum of squares, with the prior's
};

/// `done`: relative change of the sum of squares at which the search stops.
double search(const Problem& problem, VectorXd& q, int most_evaluations, double done) {
  Eigen::LevenbergMarquardt<Problem> solver(const_cast<Problem&>(problem));
  solver.parameters.ftol = done, solver.parameters.xtol = done;
  solver.parameters.maxfev = most_evaluations;
  solver.minimize(q);
  return solver.fnorm * solver.fnorm;
}

/// Structures at which a search starts.
struct Start {
  double epidermis, spongy, palisade, spongy_share;
};
constexpr Start kStarts[] = {{5, 5, 1, 0.05}, {2, 2, 1, 0.3}, {12, 8, 4, 0.15}, {3, 5, 2, 0.2}};

/// The best leaf of each kind with only its chemistry free, the best one first.
std::vector<Candidate> first_candidates(const FitRequest& request, const ThreadPool& pool) {
  constexpr int kEvaluations = 40;
  constexpr double kRoughly = 1e-3;
  std::vector<Candidate> best;
  for (const Structure structure : {Structure::bifacial, Structure::unifacial}) {
    if (request.structure && *request.structure != structure) continue;
    for (const bool sieve : {false, true}) {
      if (request.sieve && *request.sieve != sieve) continue;
      Candidate candidate{std::make_unique<LeafSpace>(request, structure, sieve), {}, HUGE_VAL};
      const Problem problem(request, *candidate.space, Grade::coarse, false, pool);
      for (const Start& start : kStarts) {
        TissueParams p = candidate.space->origin();
        for (const FitVariable* v : candidate.space->free()) {
          if (v->number == &TissueParams::epidermis_aspect) p.epidermis_aspect = start.epidermis;
          if (v->number == &TissueParams::spongy_aspect) p.spongy_aspect = start.spongy;
          if (v->number == &TissueParams::palisade_aspect) p.palisade_aspect = start.palisade;
          if (v->number == &TissueParams::spongy_share) p.spongy_share = start.spongy_share;
        }
        VectorXd q = candidate.space->of(p);
        const double cost = search(problem, q, kEvaluations, kRoughly);
        if (cost < candidate.cost) candidate.cost = cost, candidate.q = q;
      }
      best.push_back(std::move(candidate));
    }
  }
  std::ranges::sort(best, {}, &Candidate::cost);
  return best;
}

/// Correlation of neighbouring residuals along the spectrum.
double neighbours(const std::vector<double>& residuals) {
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

/// R and T at the measurements, solved with the fitted parameters.
void solve_measurements(const FitRequest& request, FitResult& result, const ThreadPool& pool) {
  constexpr int kNodes = 4;
  const TissueModel model(result.params);
  result.fitted.resize(request.measurements.size());
  pool.for_each(static_cast<int64_t>(request.measurements.size()), [&](int64_t index, int) {
    const auto i = static_cast<size_t>(index);
    const LeafMeasurement& measurement = request.measurements[i];
    const Shares s = solve(model.at(measurement.lambda_nm), std::array{measurement.theta_deg}, kNodes)[0];
    result.fitted[i] = {s.surface + s.subsurface, s.transmitted, false};
  });
}

/// A constituent whose content per area is reported.
struct Content {
  std::string_view name;
  double (*of)(const TissueParams&);  ///< kg/m^2
};
constexpr Content kContents[] = {
    {"chlorophyll", [](const TissueParams& p) { return area_content(p, p.chlorophyll_a + p.chlorophyll_b); }},
    {"carotenoids", [](const TissueParams& p) { return area_content(p, p.carotenoids); }},
    {"anthocyanins", [](const TissueParams& p) { return area_content(p, p.anthocyanins); }},
    {"water", [](const TissueParams& p) { return area_content(p, kWaterConcentration); }},
    {"drymatter",
     [](const TissueParams& p) { return area_content(p, p.dry_matter + p.protein + p.cellulose + p.lignin); }},
};

void judge(const FitRequest& request, const Problem& problem, const LeafSpace& space, FitResult& result) {
  std::vector<double> r, t;
  for (size_t i = 0; i < request.measurements.size(); ++i) {
    const LeafMeasurement& measurement = request.measurements[i];
    FitResult::Fitted& fitted = result.fitted[i];
    if (measurement.r) r.push_back(fitted.r - *measurement.r);
    if (measurement.t) t.push_back(fitted.t - *measurement.t);
    fitted.is_outlier = (measurement.r && std::abs(fitted.r - *measurement.r) > Huber::kFar) ||
                        (measurement.t && std::abs(fitted.t - *measurement.t) > Huber::kFar);
  }
  result.rmse_r = root_mean_square(r), result.rmse_t = root_mean_square(t);
  const double rho = (static_cast<double>(r.size()) * neighbours(r) + static_cast<double>(t.size()) * neighbours(t)) /
                     static_cast<double>(r.size() + t.size());
  r.insert(r.end(), t.begin(), t.end());
  result.rmse = root_mean_square(r);

  const Index n = space.count();
  const double spare = std::max(1.0, static_cast<double>(problem.rows() - n));
  const double error = std::max(request.least_error, result.rmse * std::sqrt(static_cast<double>(r.size()) / spare));
  const double variance = error * error * (1 + rho) / (1 - rho);
  MatrixXd j(problem.rows(), n);
  problem.jacobian(result.params, j, false);
  // The almost flat prior makes the error of a parameter that the measurements do not determine large but finite.
  constexpr double kVague = 10;
  MatrixXd information = j.transpose() * j / variance;
  for (Index i = 0; i < n; ++i) {
    const double expected = request.has_prior ? problem.expectation() / error : 0;
    information(i, i) += expected * expected + 1 / (kVague * kVague);
  }
  const MatrixXd covariance = information.ldlt().solve(MatrixXd::Identity(n, n));
  result.correlations.assign(static_cast<size_t>(n), std::vector<double>(static_cast<size_t>(n)));
  for (Index a = 0; a < n; ++a)
    for (Index b = 0; b < n; ++b)
      result.correlations[static_cast<size_t>(a)][static_cast<size_t>(b)] =
          covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
  for (const FitVariable& v : kFitVariables) {
    if (!space.has(v)) continue;
    FittedNumber number{&v, result.params.*v.number};
    const auto place = std::ranges::find(space.free(), &v);
    number.is_fixed = place == space.free().end();
    if (!number.is_fixed) {
      const auto i = static_cast<Index>(place - space.free().begin());
      number.relative_error = std::sqrt(covariance(i, i));
      constexpr double kNear = 1.02;
      number.is_at_bound = number.value < v.range.min * kNear || number.value > v.range.max / kNear;
    }
    result.numbers.push_back(number);
  }
  // Contents per area, with the errors of linearised products.
  constexpr double kStep = 1e-4;
  for (const Content& content : kContents) {
    const double value = content.of(result.params);
    if (!(value > 0)) continue;
    VectorXd slope(n);
    for (Index i = 0; i < n; ++i) {
      const FitVariable& v = space.variable(i);
      const TissueParams moved = space.with(result.params, v, result.params.*v.number * std::exp(kStep));
      slope[i] = std::log(content.of(moved) / value) / kStep;
    }
    result.contents.push_back({content.name, value, std::sqrt(std::max(0.0, slope.dot(covariance * slope)))});
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

FitResult fit_leaf(const FitRequest& request, const ThreadPool& pool) {
  constexpr size_t kKept = 2;  // kinds of leaves that continue
  constexpr int kFirst = 8, kCoarse = 30, kFine = 15;
  constexpr double kRoughly = 1e-2, kDone = 1e-3;
  std::vector<Candidate> candidates = first_candidates(request, pool);
  const auto continue_all = [&](int evaluations, double done) {
    for (Candidate& c : candidates)
      c.cost = search(Problem(request, *c.space, Grade::coarse, true, pool), c.q, evaluations, done);
    std::ranges::sort(candidates, {}, &Candidate::cost);
  };
  continue_all(kFirst, kRoughly);
  candidates.resize(std::min(candidates.size(), kKept));
  continue_all(kCoarse, kDone);
  Candidate& best = candidates.front();
  const Problem problem(request, *best.space, Grade::fine, true, pool);
  search(problem, best.q, kFine, kDone);
  FitResult result;
  result.params = best.space->at(best.q), result.specimen = &best.space->specimen();
  solve_measurements(request, result, pool);
  judge(request, problem, *best.space, result);
  result.misfits = misfit_bands(request, result);
  return result;
}

}  // namespace frond::leaf
