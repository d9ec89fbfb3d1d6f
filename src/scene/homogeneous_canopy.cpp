#include "scene/homogeneous_canopy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/instance_writer.h"

namespace frond {
namespace {

constexpr double kPiD = std::numbers::pi;

constexpr LeafAngles kDistributions[] = {
    {"spherical", [](double theta) { return std::sin(theta); }},
    {"planophile", [](double theta) { return 1 + std::cos(2 * theta); }},
    {"erectophile", [](double theta) { return 1 - std::cos(2 * theta); }},
    {"plagiophile", [](double theta) { return 1 - std::cos(4 * theta); }},
    {"extremophile", [](double theta) { return 1 + std::cos(4 * theta); }},
    {"uniform", [](double) { return 1.0; }},
    {"horizontal", nullptr},
};

}  // namespace

std::span<const LeafAngles> leaf_angle_distributions() { return kDistributions; }

uint64_t HomogeneousCanopy::leaves() const {
  if (count > 0) return count;
  return uint64_t(std::llround(leaf_area_index * size[0] * size[1] / (leaf_area * scale * scale)));
}

LeafPlacer::LeafPlacer(const HomogeneousCanopy& canopy) : canopy_(canopy) {
  constexpr int kSteps = 1 << 14;
  if (!canopy.angles->density) {
    angle_at_ = {0, 0};
    return;
  }
  // The cumulative distribution by the midpoint rule, then its inverse at even steps.
  std::vector<double> cumulative{0};
  const double step = kPiD / 2 / kSteps;
  for (int i = 0; i < kSteps; ++i) cumulative.push_back(cumulative.back() + canopy.angles->density((i + 0.5) * step));
  size_t below = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double wanted = cumulative.back() * i / kSteps;
    while (below + 1 < size_t(kSteps) && cumulative[below + 1] < wanted) ++below;
    const double width = cumulative[below + 1] - cumulative[below];
    const double within = width > 0 ? std::clamp((wanted - cumulative[below]) / width, 0.0, 1.0) : 0;
    angle_at_.push_back((double(below) + within) * step);
  }
}

Vec3d LeafPlacer::position(RandomStream& random) const {
  const auto between = [&random](double a, double b) { return std::lerp(a, b, random.uniform_double()); };
  if (canopy_.ball == 0) {
    const double x = between(0, canopy_.size[0]), y = between(0, canopy_.size[1]);
    return {x, y, between(canopy_.heights[0], canopy_.heights[1])};
  }
  const double z = between(-1, 1), phi = between(0, 2 * kPiD), r = canopy_.ball * std::cbrt(random.uniform_double());
  const double ring = std::sqrt(1 - z * z);
  return Vec3d{ring * std::cos(phi), ring * std::sin(phi), z} * r;
}

AffineMap LeafPlacer::place(uint64_t leaf, std::span<float> values) const {
  RandomStream random(hash_key(canopy_.seed, leaf));
  const auto between = [&random](double a, double b) { return std::lerp(a, b, random.uniform_double()); };
  const Vec3d at_position = position(random);
  const double at = random.uniform_double() * double(angle_at_.size() - 1);
  const auto i = std::min(size_t(at), angle_at_.size() - 2);
  const double theta = std::lerp(angle_at_[i], angle_at_[i + 1], at - double(i)), phi = between(0, 2 * kPiD);
  const Vec3d normal{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  const double spin = between(0, 2 * kPiD);
  for (size_t c = 0; c < canopy_.columns.size(); ++c)
    values[c] = float(between(canopy_.columns[c].range.min, canopy_.columns[c].range.max));
  return oriented_map(at_position, normal, spin, canopy_.scale);
}

}  // namespace frond
