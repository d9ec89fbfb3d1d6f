#include "scene/geometry/density_table.h"

#include <algorithm>
#include <cmath>

namespace frond {

DensityTable::DensityTable(std::vector<Point> points) : points_(std::move(points)), cumulative_{0} {
  for (size_t i = 1; i < points_.size(); ++i) {
    const Point &a = points_[i - 1], &b = points_[i];
    cumulative_.push_back(cumulative_.back() + (b.at - a.at) * (a.density + b.density) / 2);
  }
}

double DensityTable::integral_to(double at) const {
  if (at <= points_.front().at) return 0;
  if (at >= points_.back().at) return integral();
  const auto i = size_t(std::ranges::upper_bound(points_, at, {}, &Point::at) - points_.begin());
  const Point &a = points_[i - 1], &b = points_[i];
  const double x = at - a.at, slope = (b.density - a.density) / (b.at - a.at);
  return cumulative_[i - 1] + x * (a.density + slope * x / 2);
}

/// Solves the quadratic equation of a segment in the form that is stable for a small slope.
double DensityTable::quantile(double u) const {
  const double wanted = u * integral();
  auto i = size_t(std::ranges::upper_bound(cumulative_, wanted) - cumulative_.begin());
  i = std::clamp<size_t>(i, 1, points_.size() - 1);
  const Point &a = points_[i - 1], &b = points_[i];
  const double rest = wanted - cumulative_[i - 1], slope = b.at > a.at ? (b.density - a.density) / (b.at - a.at) : 0;
  const double root = a.density + std::sqrt(std::max(0.0, a.density * a.density + 2 * slope * rest));
  return root > 0 ? std::min(a.at + 2 * rest / root, b.at) : a.at;
}

}  // namespace frond
