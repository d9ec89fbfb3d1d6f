#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/world.h"
#include "integrators/light_tree.h"

namespace frond {

/// Chooses one light of the scene for a sample that competes with scattered rays.
class LightSelector {
 public:
  enum class Strategy : uint8_t {
    uniform,
    power,
    tree,  ///< by what lights may give at the point
  };
  struct Choice {
    const Light* light;
    float probability;
  };
  /// Of a surface: where it is, and its unit geometric normal.
  struct Place {
    Vec3 p, n;
  };

  LightSelector() = default;
  LightSelector(const World& world, Strategy strategy);

  bool empty() const { return lights_.empty(); }
  /// More than one light: `choose` reads its number.
  bool has_choice() const { return lights_.size() > 1; }
  /// Some light has points or directions to sample: all but delta lights.
  bool has_extent() const { return has_extent_; }
  /// Nothing where no light reaches the place.
  std::optional<Choice> choose(const Place& place, float u) const;
  float probability(const Light& light, const Place& place) const;

 private:
  /// Of all at this place, that one of the tree is chosen.
  float tree_share(const Place& place) const;

  std::vector<const Light*> lights_;  ///< those that are chosen the same way everywhere, then those of the tree
  std::vector<float> probability_;    ///< by index of all of the scene's lights: among the former; else 0
  std::vector<float> cumulative_;     ///< of the former
  float irradiance_ = 0;              ///< of the former together
  LightTree tree_;
  std::vector<const Light*> of_tree_;  ///< by its numbers, which are indices of the scene's lights
  bool has_extent_ = false;
};

}  // namespace frond
