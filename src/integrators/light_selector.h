#pragma once

#include <vector>

#include "core/world.h"

namespace frond {

/// Chooses one light of the scene, the same way at every hit.
class LightSelector {
 public:
  struct Choice {
    const Light* light;
    float probability;
  };

  LightSelector() = default;
  /// By power, or uniformly.
  LightSelector(const World& world, bool by_power);

  bool empty() const { return lights_.empty(); }
  Choice choose(float u) const;
  float probability(const Light& light) const { return probability_[size_t(light.index())]; }

 private:
  std::vector<const Light*> lights_;
  std::vector<float> probability_, cumulative_;
};

}  // namespace frond
