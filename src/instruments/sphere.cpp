#include "instruments/sphere.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace frond {

Vec3 sphere_direction(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(std::max(0.0, (1 - cos_theta) * (1 + cos_theta)));
  return {static_cast<float>(sin_theta * std::cos(phi)), static_cast<float>(sin_theta * std::sin(phi)),
          static_cast<float>(cos_theta)};
}

Vec3 SphereBox::at(double u, double v) const {
  return sphere_direction(std::lerp(z0, z1, u), std::lerp(phi0, phi1, v));
}

SphereBins::Point SphereBins::point(const Vec3& w) {
  const double phi = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x));
  return {w.z, phi < 0 ? phi + 2 * std::numbers::pi : phi};
}

SphereBins::SphereBins(std::span<const Vec3> directions, int bins)
    : largest_count_(std::max<size_t>(8, directions.size() / static_cast<size_t>(std::max(1, bins)))) {
  std::vector<Point> points;
  points.reserve(directions.size());
  for (const Vec3& w : directions) points.push_back(point(w));
  root_ = build({}, points, 0);
}

namespace {

constexpr int kEvenSplits = 4;     // first ones, in the middle of the box whatever it holds: no box over 1/16 sphere
constexpr int kDeepestSplit = 32;  // ends the cutting where many directions are the same one
constexpr size_t kCellPoints = 20;

}  // namespace

/// Cuts a box in two, by turns in cos theta and phi: in the middle, or at the median of the points.
SphereBins::Cut SphereBins::cut(const SphereBox& box, std::span<Point> points, int depth) {
  Cut cut{.by_phi = depth % 2 == 1};
  const auto coordinate = [&cut](const Point& p) { return cut.by_phi ? p.phi : p.z; };
  const double low = cut.by_phi ? box.phi0 : box.z0, high = cut.by_phi ? box.phi1 : box.z1;
  cut.at = (low + high) / 2;
  if (depth >= kEvenSplits && !points.empty()) {
    const auto middle = points.begin() + static_cast<ptrdiff_t>(points.size() / 2);
    std::ranges::nth_element(points, middle, {}, coordinate);
    if (const double median = coordinate(*middle); median > low && median < high) cut.at = median;
  }
  const auto above = std::ranges::partition(points, [&](const Point& p) { return coordinate(p) < cut.at; });
  cut.points_above = {above.begin(), above.end()};
  cut.points_below = points.first(points.size() - cut.points_above.size());
  cut.below = cut.above = box;
  (cut.by_phi ? cut.below.phi1 : cut.below.z1) = (cut.by_phi ? cut.above.phi0 : cut.above.z0) = cut.at;
  return cut;
}

size_t SphereBins::build(const SphereBox& box, std::span<Point> points, int depth) {
  if (depth >= kDeepestSplit || (depth >= kEvenSplits && points.size() <= largest_count_)) {
    cells_begin_.push_back(cells_.size());
    cut_into_cells(box, points, depth);
    boxes_.push_back(box);
    nodes_.push_back({.below = boxes_.size() - 1, .leaf = true});
  } else {
    const Cut c = cut(box, points, depth);
    Node node{.by_phi = c.by_phi, .split = c.at};
    node.below = build(c.below, c.points_below, depth + 1);
    node.above = build(c.above, c.points_above, depth + 1);
    nodes_.push_back(node);
  }
  return nodes_.size() - 1;
}

void SphereBins::cut_into_cells(const SphereBox& box, std::span<Point> points, int depth) {
  if (depth >= kDeepestSplit || points.size() <= kCellPoints) {
    cells_.push_back(box);
    return;
  }
  const Cut c = cut(box, points, depth);
  cut_into_cells(c.below, c.points_below, depth + 1);
  cut_into_cells(c.above, c.points_above, depth + 1);
}

double SphereBins::integral(size_t bin, const Density& density, double tolerance) const {
  const size_t end = bin + 1 < size() ? cells_begin_[bin + 1] : cells_.size();
  double sum = 0;
  for (size_t i = cells_begin_[bin]; i < end; ++i) sum += integrate(cells_[i], density, tolerance);
  return sum;
}

size_t SphereBins::find(const Vec3& w) const {
  const Point p = point(w);
  const Node* node = &nodes_[root_];
  while (!node->leaf) node = &nodes_[(node->by_phi ? p.phi : p.z) < node->split ? node->below : node->above];
  return node->below;
}

namespace {

constexpr int kOrder = 5;
struct Rule {
  std::array<double, kOrder> x, weight;  // on [0, 1]
};

Rule gauss_rule() {
  using Gauss = boost::math::quadrature::gauss<double, kOrder>;
  const auto& nodes = Gauss::abscissa();  // the half that is not negative, 0 first
  const auto& weights = Gauss::weights();
  Rule rule{};
  rule.x[0] = 0.5, rule.weight[0] = weights[0] / 2;
  for (size_t i = 1; i < nodes.size(); ++i) {
    rule.x[2 * i - 1] = (1 - nodes[i]) / 2, rule.x[2 * i] = (1 + nodes[i]) / 2;
    rule.weight[2 * i - 1] = rule.weight[2 * i] = weights[i] / 2;
  }
  return rule;
}

double product_rule(const SphereBox& box, const Density& density) {
  static const Rule rule = gauss_rule();
  double sum = 0;
  for (size_t i = 0; i < kOrder; ++i)
    for (size_t j = 0; j < kOrder; ++j) sum += rule.weight[i] * rule.weight[j] * density(box.at(rule.x[i], rule.x[j]));
  return sum * box.solid_angle();
}

constexpr double kRelative = 1e-4;  // finer, the rounding of float densities would drive the cutting

double refine(const SphereBox& box, const Density& density, double tolerance, double whole, int depth) {
  const double z = (box.z0 + box.z1) / 2, phi = (box.phi0 + box.phi1) / 2;
  const std::array<SphereBox, 4> parts{
      {{box.z0, z, box.phi0, phi}, {box.z0, z, phi, box.phi1}, {z, box.z1, box.phi0, phi}, {z, box.z1, phi, box.phi1}}};
  std::array<double, 4> values{};
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) sum += values[i] = product_rule(parts[i], density);
  if (depth == 0 || !(std::abs(sum - whole) > tolerance + kRelative * std::abs(sum))) return sum;
  sum = 0;
  for (size_t i = 0; i < 4; ++i) sum += refine(parts[i], density, tolerance, values[i], depth - 1);
  return sum;
}

}  // namespace

double integrate(const SphereBox& box, const Density& density, double tolerance) {
  constexpr int kDeepest = 8;
  return refine(box, density, tolerance, product_rule(box, density), kDeepest);
}

}  // namespace frond
