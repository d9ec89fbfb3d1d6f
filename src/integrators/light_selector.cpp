#include "integrators/light_selector.h"

#include <algorithm>
#include <numbers>

namespace frond {
namespace {

/// Of a light that shines from everywhere, on a surface that faces it.
double irradiance(const Light& light, double power, double radius) {
  constexpr double kOfSky = 4;  // a sky's power enters the sphere around the scene from all sides
  const double e = power / (std::numbers::pi * radius * radius);
  return light.is_delta() ? e : e / kOfSky;
}

}  // namespace

LightSelector::LightSelector(const World& world, Strategy strategy)
    : probability_(world.lights().size(), 0.f), of_tree_(world.lights().size(), nullptr) {
  constexpr double kLeast = 1e-3;  // of the mean: what has no luminance may still shine in the infrared
  std::vector<double> powers;
  double total = 0;
  for (const Light* light : world.lights()) {
    const double share = light->competing_share();
    if (share == 0) continue;
    lights_.push_back(light);
    has_extent_ = has_extent_ || !light->is_delta();
    total += powers.emplace_back(strategy == Strategy::uniform ? 1 : share * light->power(world.radius()));
  }
  const double least = total > 0 ? kLeast * total / double(powers.size()) : 1;
  std::vector<LightTree::Entry> entries;
  std::vector<double> weights;
  std::vector<size_t> everywhere;
  double sum = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    const Light& light = *lights_[i];
    const double power = std::max(powers[i], least);
    const auto bounds = strategy == Strategy::tree && lights_.size() > 1 ? light.bounds() : std::nullopt;
    if (bounds) {
      of_tree_[size_t(light.index())] = &light;
      entries.push_back({uint32_t(light.index()), *bounds, power});
      continue;
    }
    everywhere.push_back(i);
    sum += weights.emplace_back(strategy == Strategy::tree ? irradiance(light, power, double(world.radius())) : power);
  }
  tree_ = LightTree(std::move(entries));
  irradiance_ = float(sum);
  double before = 0;
  for (size_t i = 0; i < everywhere.size(); ++i) {
    const double p = weights[i] / sum;
    probability_[size_t(lights_[everywhere[i]]->index())] = float(p);
    cumulative_.push_back(float(before += p));
  }
  std::ranges::stable_partition(lights_, [this](const Light* light) { return !of_tree_[size_t(light->index())]; });
}

float LightSelector::tree_share(const Place& place) const {
  if (cumulative_.empty()) return 1;
  const float importance = tree_.importance(place.p, place.n);
  return importance / (importance + irradiance_);
}

std::optional<LightSelector::Choice> LightSelector::choose(const Place& place, float u) const {
  float share = 1;
  if (!tree_.empty()) {
    const float of_tree = tree_share(place);
    if (u < of_tree) {
      const auto choice = tree_.choose(place.p, place.n, std::min(u / of_tree, 0x1.fffffep-1f));
      if (!choice) return {};
      return Choice{of_tree_[choice->light], of_tree * choice->probability};
    }
    share = 1 - of_tree;
    u = std::min((u - of_tree) / share, 0x1.fffffep-1f);
  }
  const size_t last = cumulative_.size() - 1;
  size_t i = last == 0 ? 0 : size_t(std::upper_bound(cumulative_.begin(), cumulative_.end(), u) - cumulative_.begin());
  const Light* light = lights_[std::min(i, last)];
  return Choice{light, share * probability_[size_t(light->index())]};
}

float LightSelector::probability(const Light& light, const Place& place) const {
  const auto index = size_t(light.index());
  if (tree_.empty()) return probability_[index];
  const float of_tree = tree_share(place);
  return of_tree_[index] ? of_tree * tree_.probability(place.p, place.n, uint32_t(index))
                         : (1 - of_tree) * probability_[index];
}

}  // namespace frond
