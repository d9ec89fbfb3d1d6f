#include "integrators/light_selector.h"

#include <algorithm>
#include <numbers>

#include "core/stop.h"

namespace frond {
namespace {

/// Irradiance of a light that does not depend on the point, on a surface that faces it.
double irradiance(const Light& light, double power, double radius) {
  constexpr double kOfSky = 4;  // area of the scene's sphere over that of its disc
  const double e = power / (std::numbers::pi * radius * radius);
  return light.is_delta() ? e : e / kOfSky;
}

/// Whether a light has an area to sample, also if no ray can hit it.
bool has_points(const Light& light) {
  const auto bounds = light.bounds();
  return bounds && !(bounds->min == bounds->max);
}

}  // namespace

LightSelector::LightSelector(const World& world, Strategy strategy)
    : lights_(world.lights().begin(), world.lights().end()), probability_(lights_.size(), 0.f) {
  constexpr double kLeast = 1e-3;  // of the mean: a light without luminance may emit in the infrared
  std::vector<double> powers(lights_.size(), 0);
  double total = 0;
  StopPoll poll;
  for (size_t i = 0; i < lights_.size(); ++i) {
    poll();
    const double share = lights_[i]->compensated_share();
    if (share == 0) continue;
    ++count_;
    has_extent_ = has_extent_ || !lights_[i]->is_delta() || has_points(*lights_[i]);
    total += powers[i] = strategy == Strategy::uniform ? 1 : share * lights_[i]->power(world.radius());
  }
  const double least = total > 0 ? kLeast * total / double(count_) : 1;
  std::vector<LightTree::Entry> entries;
  std::vector<double> weights;
  double sum = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (lights_[i]->compensated_share() == 0) continue;
    const double power = std::max(powers[i], least);
    // A single light needs no tree: its probability is 1.
    const bool by_place = strategy == Strategy::tree && count_ > 1;
    if (const auto bounds = by_place ? lights_[i]->bounds() : std::nullopt) {
      entries.push_back({uint32_t(i), *bounds, power});
      continue;
    }
    outside_tree_.push_back(i);
    sum += weights.emplace_back(by_place ? irradiance(*lights_[i], power, double(world.radius())) : power);
  }
  if (count_ == 1) only_ = lights_[outside_tree_.front()];
  tree_ = LightTree(std::move(entries));
  irradiance_ = float(sum);
  double before = 0;
  for (size_t i = 0; i < outside_tree_.size(); ++i) {
    probability_[outside_tree_[i]] = float(weights[i] / sum);
    cumulative_.push_back(float(before += weights[i] / sum));
  }
}

float LightSelector::tree_share(const LitPoint& point) const {
  if (outside_tree_.empty()) return 1;
  const float importance = tree_.importance(point.p, point.n);
  return importance / (importance + irradiance_);
}

std::optional<LightSelector::Choice> LightSelector::choose_among_all(const LitPoint& point, float& u) const {
  float share = 1;
  // u draws between the tree and the other lights, then is rescaled to [0, 1) and reused.
  if (!tree_.empty()) {
    const float of_tree = tree_share(point);
    if (u < of_tree) {
      u = std::min(u / of_tree, 0x1.fffffep-1f);
      const auto choice = tree_.choose(point.p, point.n, u);
      if (!choice) return {};
      return Choice{lights_[choice->light], of_tree * choice->probability};
    }
    share = 1 - of_tree;
    u = std::min((u - of_tree) / share, 0x1.fffffep-1f);
  }
  const size_t last = cumulative_.size() - 1;
  size_t i = last == 0 ? 0 : size_t(std::upper_bound(cumulative_.begin(), cumulative_.end(), u) - cumulative_.begin());
  i = std::min(i, last);
  const size_t place_of_light = outside_tree_[i];
  const float before = i == 0 ? 0 : cumulative_[i - 1], own = probability_[place_of_light];
  u = std::clamp((u - before) / own, 0.f, 0x1.fffffep-1f);
  return Choice{lights_[place_of_light], share * own};
}

float LightSelector::probability(const Light& light, const LitPoint& point) const {
  if (count_ == 1) return &light == only_ ? 1.f : 0.f;
  const auto i = size_t(light.index());
  if (tree_.empty()) return probability_[i];
  const float of_tree = tree_share(point);
  return of_tree * tree_.probability(point.p, point.n, uint32_t(i)) + (1 - of_tree) * probability_[i];
}

}  // namespace frond
