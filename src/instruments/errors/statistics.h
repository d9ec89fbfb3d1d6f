#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace frond {

/// A measured number and its standard error.
struct MeanError {
  double mean = 0, standard_error = 0;
};

/// Returns a value times a number without an error.
inline MeanError scaled(const MeanError& v, double factor) { return {v.mean * factor, v.standard_error * factor}; }
/// Returns v / by for independent errors; not a number unless `by` is above 0.
inline MeanError divided(const MeanError& v, const MeanError& by) {
  if (!(by.mean > 0)) return {NAN, NAN};
  const double ratio = v.mean / by.mean;
  return {ratio, std::hypot(v.standard_error, ratio * by.standard_error) / by.mean};
}

/// An estimated expectation, with the variance and the third cumulant of the estimate; both add for independent
/// estimates.
struct Estimate {
  double mean = 0, variance = 0, third_cumulant = 0;

  double standard_error() const { return std::sqrt(variance); }
  Estimate& operator+=(const Estimate& other) {
    mean += other.mean;
    variance += other.variance;
    third_cumulant += other.third_cumulant;
    return *this;
  }
};

/// Running sums of a sample, for its mean and the mean's error.
class Moments {
 public:
  void add(double x) {
    ++count_;
    sum_ += x;
    sum_of_squares_ += x * x;
    sum_of_cubes_ += x * x * x;
  }
  void add(const Moments& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    sum_of_squares_ += other.sum_of_squares_;
    sum_of_cubes_ += other.sum_of_cubes_;
  }
  /// Adds the value 0 that many times.
  void add_zeros(int64_t zeros) { count_ += zeros; }

  int64_t count() const { return count_; }
  /// 0 for no values.
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  /// Unbiased variance of the values; 0 for fewer than two.
  double variance() const;
  /// Estimate of the expectation.
  Estimate estimate() const;
  /// Effective sample size (Kish 1965): sum^2 / sum of squares.
  double effective_count() const { return sum_of_squares_ > 0 ? sum_ * sum_ / sum_of_squares_ : 0; }

 private:
  int64_t count_ = 0;
  double sum_ = 0, sum_of_squares_ = 0, sum_of_cubes_ = 0;
};

/// P(Z >= z) of a standard normal variable.
double normal_upper_tail(double z);

/// The z with P(Z >= z) = `p`.
double normal_upper_quantile(double p);

/// Two-sided p-value of "the two have equal expectations", by a z-test with the skewness removed (Hall 1992, "On the
/// Removal of Skewness by Transformation"): means of Monte Carlo weights are far from normal in the tails, which decide
/// the test. A difference of up to `slack`, for rounding, counts as none. NaN on either side returns 0.
double equality_p(const Estimate& a, const Estimate& b, double slack);

/// Confidence interval of the expectation: each end is exceeded with the probability that a standard normal variable
/// exceeds `z`, by the same test.
struct ConfidenceInterval {
  double low, high;
};
ConfidenceInterval confidence_interval(const Estimate& a, double z);

/// One-sided p-value of "the expectation is at most `bound`", by the same test.
double at_most_p(const Estimate& a, double bound, double slack);

/// Two-sided p-value of `successes` out of `trials` for the most favourable success probability in [low, high].
double binomial_p(int64_t successes, int64_t trials, double low, double high);

/// Pearson's chi-square test of counts against expectations.
struct ChiSquare {
  double statistic = 0;
  int freedom = 0;  ///< degrees of freedom: classes - 1
  double p = 1;     ///< probability of a statistic at least as large
};

/// Classes are pooled, in their order, until each expects at least 5 (Cochran 1954). p is 1 if fewer than two remain,
/// and 0 if an expectation is not a number.
ChiSquare chi_square(std::span<const double> observed, std::span<const double> expected);
/// The p-value alone.
inline double chi_square_p(std::span<const double> observed, std::span<const double> expected) {
  return chi_square(observed, expected).p;
}

/// Significance level of each of `tests` tests such that the probability of any false alarm is at most `rate` (Sidak
/// 1967).
double sidak_level(double rate, size_t tests);

}  // namespace frond
