#include "instruments/errors/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace frond {
namespace {

double hall_transform(double t, double skewness) {
  const double a = skewness / 3;
  return t + a * t * t + a * a * t * t * t / 3 + skewness / 6;
}

/// Hall's cubic is the cube of a linear function plus a constant, so its inverse has a closed form.
double inverse_hall_transform(double score, double skewness) {
  const double a = skewness / 3, t = score - skewness / 6;
  return std::abs(a) < 1e-9 ? t : (std::cbrt(1 + 3 * a * t) - 1) / a;
}

/// Approximately standard normal if only chance and a difference of up to `slack` separate the two.
double normal_score(const Estimate& difference, double slack) {
  if (!std::isfinite(difference.mean) || !std::isfinite(difference.variance))
    return std::numeric_limits<double>::infinity();
  const double excess = std::copysign(std::max(0.0, std::abs(difference.mean) - slack), difference.mean);
  if (excess == 0) return 0;
  if (difference.variance == 0) return std::copysign(std::numeric_limits<double>::infinity(), excess);
  const double se = difference.standard_error();
  return hall_transform(excess / se, difference.third_cumulant / (se * se * se));
}

}  // namespace

double Moments::variance() const {
  if (count_ < 2) return 0;
  const double n = static_cast<double>(count_);
  return std::max(0.0, (sum_of_squares_ - sum_ * sum_ / n) / (n - 1));
}

Estimate Moments::estimate() const {
  if (count_ == 0) return {};
  const double n = static_cast<double>(count_), m = mean();
  const double third = sum_of_cubes_ / n - 3 * m * sum_of_squares_ / n + 2 * m * m * m;
  return {m, variance() / n, third / (n * n)};
}

double normal_upper_tail(double z) { return std::isinf(z) ? (z < 0) : cdf(complement(boost::math::normal(), z)); }

double normal_upper_quantile(double p) { return quantile(complement(boost::math::normal(), p)); }

double equality_p(const Estimate& a, const Estimate& b, double slack) {
  Estimate difference{-b.mean, b.variance, -b.third_cumulant};
  return std::min(1.0, 2 * normal_upper_tail(std::abs(normal_score(difference += a, slack))));
}

ConfidenceInterval confidence_interval(const Estimate& a, double z) {
  const double se = a.standard_error();
  if (se == 0) return {a.mean, a.mean};
  const double skewness = a.third_cumulant / (se * se * se);
  return {a.mean - se * inverse_hall_transform(z, skewness), a.mean - se * inverse_hall_transform(-z, skewness)};
}

double at_most_p(const Estimate& a, double bound, double slack) {
  const double score = normal_score({a.mean - bound, a.variance, a.third_cumulant}, slack);
  return score > 0 ? normal_upper_tail(score) : 1;
}

double binomial_p(int64_t successes, int64_t trials, double low, double high) {
  assert(trials > 0 && low <= high);
  const double rate = static_cast<double>(successes) / static_cast<double>(trials);
  const double probability = std::clamp(std::clamp(rate, low, high), 0.0, 1.0);
  if (probability == rate) return 1;
  if (probability == 0 || probability == 1) return 0;
  const boost::math::binomial distribution(static_cast<double>(trials), probability);
  const double k = static_cast<double>(successes);
  const double below = cdf(distribution, k), above = k > 0 ? cdf(complement(distribution, k - 1)) : 1;
  return std::min(1.0, 2 * std::min(below, above));
}

ChiSquare chi_square(std::span<const double> observed, std::span<const double> expected) {
  assert(observed.size() == expected.size());
  struct Class {
    double observed = 0, expected = 0;
  };
  std::vector<Class> classes;
  Class open;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (!std::isfinite(expected[i])) return {.p = 0};
    open.observed += observed[i];
    open.expected += expected[i];
    if (open.expected < 5) continue;
    classes.push_back(open);
    open = {};
  }
  if (classes.size() < 2) return {};
  classes.back().observed += open.observed;
  classes.back().expected += open.expected;
  ChiSquare result{.freedom = static_cast<int>(classes.size()) - 1};
  for (const Class& c : classes) result.statistic += (c.observed - c.expected) * (c.observed - c.expected) / c.expected;
  result.p = cdf(complement(boost::math::chi_squared(result.freedom), result.statistic));
  return result;
}

double sidak_level(double rate, size_t tests) {
  assert(rate > 0 && rate < 1);
  return tests == 0 ? rate : -std::expm1(std::log1p(-rate) / static_cast<double>(tests));
}

}  // namespace frond
