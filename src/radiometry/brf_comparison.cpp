#include "radiometry/brf_comparison.h"

#include <algorithm>
#include <cmath>

#include "instruments/errors/statistics.h"

namespace frond {
namespace {

/// Converts a normal quantile to Student's t (Cornish and Fisher; Abramowitz and Stegun 26.7.5).
double student_quantile(double z, double freedom) {
  const double z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom);
}

}  // namespace

std::vector<MeanError> relative_to(const BrfMeasurement& reference, const BrfMeasurement& measurement) {
  constexpr int kRows = BrfMeter::kRows;
  std::vector<MeanError> differences;
  for (size_t i = 0; i < measurement.values.size(); ++i) {
    const double b = reference.values[i].mean, ratio = measurement.values[i].mean / b;
    std::array<double, kRows> rests;
    for (size_t row = 0; row < kRows; ++row)
      rests[row] = (measurement.rows[i * kRows + row] - ratio * reference.rows[i * kRows + row]) / b;
    differences.push_back({ratio - 1, error_of_rows(rests)});
  }
  return differences;
}

BrfVerdict check_agreement(const BrfMeasurement& reference, const BrfMeasurement& measurement, double within) {
  constexpr double kRate = 0.05;
  const auto differences = relative_to(reference, measurement);
  const double z =
      student_quantile(normal_upper_quantile(sidak_level(kRate, differences.size()) / 2), BrfMeter::kCells);
  const auto upper = [z](const MeanError& d) { return std::abs(d.mean) + z * d.standard_error; };
  const auto worst = std::ranges::max_element(differences, {}, upper);
  const bool beyond = std::ranges::any_of(
      differences, [&](const MeanError& d) { return std::abs(d.mean) - z * d.standard_error > within; });
  const auto place = size_t(worst - differences.begin());
  const bool is_known = !measurement.has_heavy_tails && !reference.has_heavy_tails;
  const auto answer = !is_known                 ? BrfVerdict::Answer::unknown
                      : beyond                  ? BrfVerdict::Answer::not_enough
                      : upper(*worst) <= within ? BrfVerdict::Answer::enough
                                                : BrfVerdict::Answer::unknown;
  const size_t bands = measurement.bands.size();
  return {answer, place / bands, place % bands, *worst, upper(*worst)};
}

}  // namespace frond
