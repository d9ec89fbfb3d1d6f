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
  /// More than one light: `choose` reads its number.
  bool has_choice() const { return lights_.size() > 1; }
  /// Some light has points or directions to sample: all but delta lights.
  bool has_extent() const { return has_extent_; }
  Choice choose(float u) const;
  float probability(const Light& light) const { return probability_[size_t(light.index())]; }

 private:
  std::vector<const Light*> lights_;
  std::vector<float> probability_, cumulative_;
  bool has_extent_ = false;
};

}  // namespace frond
