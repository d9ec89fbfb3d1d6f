#include "instruments/sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frond {

SpherePoint::SpherePoint(const Vec3& direction)
    : cos_theta(direction.z),
      phi(std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x))),
      w(direction) {
  if (phi < 0) phi += 2 * std::numbers::pi;
}

Vec3 sphere_direction(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(std::max(0.0, (1 - cos_theta) * (1 + cos_theta)));
  return {static_cast<float>(sin_theta * std::cos(phi)), static_cast<float>(sin_theta * std::sin(phi)),
          static_cast<float>(cos_theta)};
}

Vec3 SphereBox::at(double u, double v) const {
  return sphere_direction(std::lerp(z0, z1, u), std::lerp(phi0, phi1, v));
}

SphereBins::SphereBins(std::span<const Vec3> directions, int bins)
    : largest_count_(std::max<size_t>(8, directions.size() / static_cast<size_t>(std::max(1, bins)))) {
  points_.reserve(directions.size());
  for (const Vec3& w : directions) points_.emplace_back(w);
  root_ = build({}, points_, 0);
}

namespace {

constexpr int kEvenSplits = 4;     // the first splits halve the box: no box exceeds 1/16 of the sphere
constexpr int kDeepestSplit = 32;  // ends the recursion if many directions coincide

double coordinate(const SpherePoint& p, bool by_phi) { return by_phi ? p.phi : p.cos_theta; }

/// The points' median if it lies inside the box, else the middle.
double median_or_middle(std::span<SpherePoint> points, bool by_phi, double low, double high) {
  const auto middle = points.begin() + static_cast<ptrdiff_t>(points.size() / 2);
  std::ranges::nth_element(points, middle, {}, [by_phi](const SpherePoint& p) { return coordinate(p, by_phi); });
  const double median = coordinate(*middle, by_phi);
  return median > low && median < high ? median : (low + high) / 2;
}

}  // namespace

size_t SphereBins::build(const SphereBox& box, std::span<SpherePoint> points, int depth) {
  const bool must_split = depth < kEvenSplits;
  if (!must_split && (depth >= kDeepestSplit || points.size() <= largest_count_)) {
    bins_.push_back({box, points});
    nodes_.push_back({.below = bins_.size() - 1, .leaf = true});
    return nodes_.size() - 1;
  }
  const bool by_phi = depth % 2 == 1;
  const double low = by_phi ? box.phi0 : box.z0, high = by_phi ? box.phi1 : box.z1;
  const double split = must_split ? (low + high) / 2 : median_or_middle(points, by_phi, low, high);
  const auto rest =
      std::partition(points.begin(), points.end(), [&](const SpherePoint& p) { return coordinate(p, by_phi) < split; });
  const auto count = size_t(rest - points.begin());
  SphereBox below = box, above = box;
  (by_phi ? below.phi1 : below.z1) = (by_phi ? above.phi0 : above.z0) = split;
  Node node{.by_phi = by_phi, .split = split};
  node.below = build(below, points.first(count), depth + 1);
  node.above = build(above, points.subspan(count), depth + 1);
  nodes_.push_back(node);
  return nodes_.size() - 1;
}

size_t SphereBins::find(const Vec3& w) const {
  const SpherePoint p(w);
  const Node* node = &nodes_[root_];
  while (!node->leaf) node = &nodes_[coordinate(p, node->by_phi) < node->split ? node->below : node->above];
  return node->below;
}

}  // namespace frond
