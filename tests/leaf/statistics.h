#pragma once

#include <algorithm>
#include <cmath>

namespace frond::test {

/// Chance that a sound program fails one test, for every statistical test here.
inline constexpr double kFalseAlarm = 1e-6;

/// Two-sided limit in standard errors such that `comparisons` independent ones all stay within with 1 - false_alarm
/// (Sidak 1967).
inline double z_limit(int comparisons, double false_alarm = kFalseAlarm) {
  const double each = -std::expm1(std::log1p(-false_alarm) / comparisons);
  double low = 0, high = 40;
  for (int i = 0; i < 100; ++i) {
    const double z = (low + high) / 2;
    (std::erfc(z / std::sqrt(2.0)) > each ? low : high) = z;
  }
  return high;
}

/// Mean and its standard error.
class Estimate {
 public:
  void add(double x) {
    ++n_;
    sum_ += x;
    squares_ += x * x;
  }
  /// Adds this number of zeros.
  void add_zeros(int count) { n_ += count; }
  int count() const { return n_; }
  double mean() const { return sum_ / n_; }
  double standard_error() const { return std::sqrt(std::max(0.0, squares_ / n_ - mean() * mean()) / (n_ - 1)); }

 private:
  int n_ = 0;
  double sum_ = 0, squares_ = 0;
};

/// Difference of two estimates in its standard errors; 0 where both are exact and equal.
inline double z_score(const Estimate& a, const Estimate& b) {
  const double difference = a.mean() - b.mean();
  return difference == 0 ? 0 : difference / std::hypot(a.standard_error(), b.standard_error());
}

/// The chi-square of `n` squares as a standard normal variable (Wilson and Hilferty 1931).
inline double z_of_chi_square(double chi_square, int n) {
  const double variance = 2.0 / (9 * n);
  return (std::cbrt(chi_square / n) - (1 - variance)) / std::sqrt(variance);
}

}  // namespace frond::test
