#include "integrators/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/stop.h"

namespace frond {
namespace {

Vec3 componentwise_min(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3 componentwise_max(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

double angle(float cosine) { return std::acos(std::clamp(double(cosine), -1.0, 1.0)); }

/// Directions within an angle of an axis.
struct Cone {
  Vec3d axis;
  double half;
};

/// The smallest cone that contains both.
Cone union_of(Cone a, Cone b) {
  if (b.half > a.half) std::swap(a, b);
  const double between = std::acos(std::clamp(dot(a.axis, b.axis), -1.0, 1.0));
  if (between + b.half <= a.half) return a;
  const double half = (a.half + between + b.half) / 2;
  const Vec3d across = b.axis - a.axis * dot(a.axis, b.axis);
  const double length_across = length(across);
  if (half >= std::numbers::pi || length_across < 1e-9) return {a.axis, std::numbers::pi};
  const double turn = half - a.half;
  return {normalize(a.axis * std::cos(turn) + across * (std::sin(turn) / length_across)), half};
}

LightBounds union_of(const LightBounds& a, const LightBounds& b) {
  constexpr double kRounding = 1e-4;
  const Cone cone =
      union_of(Cone{to_double(a.axis), angle(a.cos_spread)}, Cone{to_double(b.axis), angle(b.cos_spread)});
  return {.min = componentwise_min(a.min, b.min),
          .max = componentwise_max(a.max, b.max),
          .axis = to_float(cone.axis),
          .cos_spread = float(std::cos(std::min(std::numbers::pi, cone.half + kRounding))),
          .cos_reach = std::min(a.cos_reach, b.cos_reach),
          .two_sided = a.two_sided || b.two_sided};
}

Vec3 middle(const LightBounds& b) { return (b.min + b.max) * 0.5f; }

/// Orientation measure M_Omega of Conty Estevez and Kulla 2018: solid angle into which a cluster emits, weighted by
/// cosines, sr.
double orientation_measure(const LightBounds& b) {
  const double spread = angle(b.cos_spread), reach = std::min(std::numbers::pi, spread + angle(b.cos_reach));
  const double once =
      2 * std::numbers::pi * (1 - std::cos(spread)) + std::numbers::pi / 2 *
                                                          (2 * reach * std::sin(spread) - std::cos(spread - 2 * reach) -
                                                           2 * spread * std::sin(spread) + std::cos(spread));
  return b.two_sided ? std::min(2 * once, 4 * std::numbers::pi) : once;
}

/// Cost of a cluster by the surface area orientation heuristic: power times orientation measure times area. The
/// smaller, the more alike its lights.
double cost(const LightBounds& b, double power, double stretch) {
  const Vec3d d = to_double(b.max) - to_double(b.min);
  constexpr double kLine = 1e-3;  // lights in a line have no area
  const double size = d.x * d.y + d.y * d.z + d.z * d.x + kLine * dot(d, d);
  return power * stretch * orientation_measure(b) * size;
}

/// Cosine of max(0, a - b) for two angles a, b.
float cos_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
/// Sine of max(0, a - b).
float sin_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
}
float sine(float cosine) { return std::sqrt(std::max(0.f, 1 - cosine * cosine)); }

struct Cluster {
  LightBounds bounds{};
  double power = 0;
  size_t count = 0;
  void add(const Cluster& other) {
    if (other.count == 0) return;
    bounds = count == 0 ? other.bounds : union_of(bounds, other.bounds);
    power += other.power;
    count += other.count;
  }
};

/// Partitions the entries by the cheapest of the planes between bins; returns the number of entries before it.
template <class Entry>
size_t partition(std::span<Entry> entries) {
  constexpr int kBins = 12;
  Vec3 low = middle(entries[0].bounds), high = low;
  for (const Entry& e : entries) {
    low = componentwise_min(low, middle(e.bounds));
    high = componentwise_max(high, middle(e.bounds));
  }
  const Vec3 extent = high - low;
  const float longest = std::max({extent.x, extent.y, extent.z});
  double best_cost = INFINITY;
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [&](const Entry& e, int axis) {
    const float place = (middle(e.bounds)[axis] - low[axis]) / extent[axis];
    return std::clamp(int(place * kBins), 0, kBins - 1);
  };
  StopPoll poll;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0)) continue;
    std::array<Cluster, kBins> bins;
    for (const Entry& e : entries) {
      poll();
      bins[size_t(bin_of(e, axis))].add({e.bounds, e.power, 1});
    }
    for (int cut = 1; cut < kBins; ++cut) {
      Cluster before, after;
      for (int i = 0; i < kBins; ++i) (i < cut ? before : after).add(bins[size_t(i)]);
      if (before.count == 0 || after.count == 0) continue;
      const double stretch = double(longest) / double(extent[axis]);
      const double c = cost(before.bounds, before.power, stretch) + cost(after.bounds, after.power, stretch);
      if (c < best_cost) best_cost = c, best_axis = axis, best_bin = cut;
    }
  }
  if (best_axis < 0) return entries.size() / 2;
  const auto cut =
      std::partition(entries.begin(), entries.end(), [&](const Entry& e) { return bin_of(e, best_axis) < best_bin; });
  return size_t(cut - entries.begin());
}

}  // namespace

LightTree::LightTree(std::vector<Entry> entries) {
  if (entries.empty()) return;
  uint32_t most = 0;
  for (const Entry& e : entries) most = std::max(most, e.light);
  trails_.resize(most + 1, ~uint64_t{0});
  nodes_.reserve(2 * entries.size());
  build(entries, 0, 0);
}

uint32_t LightTree::build(std::span<Entry> entries, uint64_t trail, int depth) {
  check_stop();
  constexpr int kBalanced = 32;  // deeper nodes are split in halves, so that paths fit into 64 bits
  const auto place = uint32_t(nodes_.size());
  nodes_.emplace_back();
  if (entries.size() == 1) {
    const LightBounds& bounds = entries[0].bounds;
    nodes_[place] = {bounds, float(entries[0].power / orientation_measure(bounds)), 0, entries[0].light};
    trails_[entries[0].light] = trail;
    return place;
  }
  const size_t cut = depth < kBalanced ? partition(entries) : entries.size() / 2;
  build(entries.first(cut), trail, depth + 1);
  const uint32_t second = build(entries.subspan(cut), trail | uint64_t{1} << depth, depth + 1);
  const Node &a = nodes_[place + 1], &b = nodes_[second];
  nodes_[place] = {union_of(a.bounds, b.bounds), a.intensity + b.intensity, second, 0};
  return place;
}

float LightTree::importance(const Node& node, const Vec3& p, const Vec3& n) {
  const LightBounds& b = node.bounds;
  const Vec3 to_light = middle(b) - p, diagonal = b.max - b.min;
  const float radius2 = dot(diagonal, diagonal) / 4, center2 = dot(to_light, to_light);
  const float distance2 = std::max({center2, radius2, 1e-30f});
  const Vec3 w = center2 > 0 ? to_light * (1 / std::sqrt(center2)) : Vec3{0, 0, 1};
  // Angular radius of the cluster as seen from the point; pi from within it.
  const float cos_size = center2 > radius2 ? std::sqrt(std::max(0.f, 1 - radius2 / center2)) : -1;
  const float sin_size = sine(cos_size);
  float cos_facing = -dot(w, b.axis);
  if (b.two_sided) cos_facing = std::abs(cos_facing);
  const float sin_spread = sine(b.cos_spread), sin_facing = sine(cos_facing);
  // Importance of Conty Estevez and Kulla 2018: the angle between the axis and the point, less the cluster's spread and
  // angular radius, bounds the emission; the angle of incidence, less the radius, bounds the cosine.
  const float cos_beyond = cos_of_difference(sin_facing, cos_facing, sin_spread, b.cos_spread);
  const float sin_beyond = sin_of_difference(sin_facing, cos_facing, sin_spread, b.cos_spread);
  // NOLINTNEXTLINE(readability-suspicious-call-argument): beyond, less the size
  const float cos_least = cos_of_difference(sin_beyond, cos_beyond, sin_size, cos_size);
  if (cos_least <= b.cos_reach) return 0;
  const float cos_in = n == Vec3{} ? 1 : std::abs(dot(w, n));  // a point of a medium has no normal
  const float cos_incident = cos_of_difference(sine(cos_in), cos_in, sin_size, cos_size);
  return std::clamp(node.intensity * cos_least * cos_incident / distance2, 0.f, 1e30f);
}

namespace {

/// Probability of the first of two nodes with these importances, not both 0. A node with an importance above 0 has at
/// least a small probability: importances neglect occlusion, and the importance of an occluded light can be far above
/// all others.
float probability_of_first(float first, float second) {
  if (first == 0 || second == 0) return second == 0 ? 1 : 0;
  constexpr float kLeast = 1e-3f;
  return std::clamp(first / (first + second), kLeast, 1 - kLeast);
}

}  // namespace

std::optional<LightTree::Choice> LightTree::choose(const Vec3& p, const Vec3& n, float& u) const {
  if (empty()) return {};
  uint32_t at = 0;
  float probability = 1;
  while (nodes_[at].second != 0) {
    const uint32_t second = nodes_[at].second;
    const float a = importance(nodes_[at + 1], p, n), b = importance(nodes_[second], p, n);
    if (!(a + b > 0)) return {};
    const float first = probability_of_first(a, b);
    if (u < first) {
      u = std::min(u / first, 0x1.fffffep-1f), probability *= first, ++at;
    } else {
      u = std::min((u - first) / (1 - first), 0x1.fffffep-1f), probability *= 1 - first, at = second;
    }
  }
  return Choice{nodes_[at].light, probability};
}

float LightTree::probability(const Vec3& p, const Vec3& n, uint32_t light) const {
  if (light >= trails_.size() || trails_[light] == ~uint64_t{0}) return 0;
  uint32_t at = 0;
  float probability = 1;
  for (uint64_t trail = trails_[light]; nodes_[at].second != 0; trail >>= 1) {
    const uint32_t second = nodes_[at].second;
    const float a = importance(nodes_[at + 1], p, n), b = importance(nodes_[second], p, n);
    if (!(a + b > 0)) return 0;
    const float first = probability_of_first(a, b);
    probability *= trail & 1 ? 1 - first : first;
    at = trail & 1 ? second : at + 1;
  }
  return probability;
}

}  // namespace frond
