#include "integrators/light_selector.h"

#include <algorithm>

namespace frond {

LightSelector::LightSelector(const World& world, bool by_power)
    : lights_(world.lights().begin(), world.lights().end()) {
  std::vector<double> powers;
  double total = 0;
  for (const Light* light : lights_) {
    total += powers.emplace_back(by_power ? light->power(world.radius()) : 1);
    has_extent_ = has_extent_ || !light->is_delta();
  }
  double sum = 0;
  for (const double power : powers) {
    // A scene whose lights all have no power still needs probabilities.
    const double p = total > 0 ? power / total : 1 / double(powers.size());
    probability_.push_back(float(p));
    cumulative_.push_back(float(sum += p));
  }
}

LightSelector::Choice LightSelector::choose(float u) const {
  const size_t last = lights_.size() - 1;
  size_t i = last == 0 ? 0 : size_t(std::upper_bound(cumulative_.begin(), cumulative_.end(), u) - cumulative_.begin());
  i = std::min(i, last);
  while (probability_[i] == 0 && i > 0) --i;  // rounding at the end of the sum
  return {lights_[i], probability_[i]};
}

}  // namespace frond
