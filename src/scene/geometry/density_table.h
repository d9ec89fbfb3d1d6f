#pragma once

#include <vector>

namespace frond {

/// Density that is linear between the points of a table and 0 beyond them; two points at one position are a step.
class DensityTable {
 public:
  struct Point {
    double at, density;
  };

  /// `points`: ascending, at least two; densities at least 0, with an integral above 0.
  explicit DensityTable(std::vector<Point> points);

  const std::vector<Point>& points() const { return points_; }
  double integral() const { return cumulative_.back(); }
  /// Returns the integral from the first point to `at`.
  double integral_to(double at) const;
  /// Returns the position below which the share `u` of the integral lies, for `u` in [0, 1].
  double quantile(double u) const;

 private:
  std::vector<Point> points_;
  std::vector<double> cumulative_;  ///< integral up to each point
};

}  // namespace frond
