#include "instruments/errors/power.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cassert>
#include <cmath>
#include <limits>

namespace frond {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Returns the number of successes that is not exceeded with the probability p.
int64_t binomial_quantile(double trials, double probability, double p) {
  if (probability <= 0) return 0;
  return static_cast<int64_t>(probability >= 1 ? trials : quantile(boost::math::binomial(trials, probability), p));
}

/// Smallest x in (0, most] with `is_found(x)`, which is monotonic; infinite if there is none.
template <class Test>
double smallest_detectable(double most, const Test& is_found) {
  if (!(most > 0) || !is_found(most)) return kInfinite;
  constexpr int kHalvings = 30;
  double missed = 0, found = most;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (missed + found) / 2;
    (is_found(middle) ? found : missed) = middle;
  }
  return found;
}

}  // namespace

/// The test rejects above t standard errors. The mean lies above its lower quantile x, in standard errors, with the
/// probability `power` (Cornish and Fisher 1938). The estimated error varies with the mean: its square by the skewness
/// times x. Hence d = t sqrt(1 + skewness x) - x.
double detectable_difference(const Estimate& a, double level, double power) {
  const double se = a.standard_error();
  if (!(se > 0)) return se;  // 0, or not a number
  const double skewness = a.third_cumulant / (se * se * se), z = normal_upper_quantile(1 - power);
  const double t = (a.mean - confidence_interval(a, normal_upper_quantile(level)).low) / se;
  const double x = -z + skewness / 6 * (z * z - 1);
  return se * std::max(0.0, t * std::sqrt(std::max(0.0, 1 + skewness * x)) - x);
}

double detectable_shortfall(int64_t trials, double low, double level, double power) {
  const double n = static_cast<double>(trials);
  return smallest_detectable(low, [&](double distance) {
    const int64_t most = binomial_quantile(n, low - distance, power);
    return static_cast<double>(most) < low * n && binomial_p(most, trials, low, low) < level;
  });
}

double detectable_surplus(int64_t trials, double probability, double level, double power) {
  const double n = static_cast<double>(trials);
  const int64_t least = binomial_quantile(n, probability, 1 - power);
  return smallest_detectable(probability, [&](double distance) {
    const double high = probability - distance;
    return static_cast<double>(least) > high * n && binomial_p(least, trials, high, high) < level;
  });
}

double detectable_share(double trials, double power) { return -std::expm1(std::log1p(-power) / trials); }

double detectable_deviation(int freedom, double count, double level, double power) {
  using boost::math::chi_squared, boost::math::non_central_chi_squared;
  const double threshold = quantile(complement(chi_squared(freedom), level));
  return std::sqrt(non_central_chi_squared::find_non_centrality(freedom, threshold, 1 - power) / count);
}

}  // namespace frond
