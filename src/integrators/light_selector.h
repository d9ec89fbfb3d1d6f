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
  struct LitPoint {
    Vec3 p, n;
  };

  LightSelector() = default;
  LightSelector(const World& world, Strategy strategy);

  bool empty() const { return count_ == 0; }
  /// More than one light: `choose` reads its number.
  bool has_choice() const { return count_ > 1; }
  /// Some light has points or directions to sample: all but delta lights, and of these surfaces that no ray meets.
  bool has_extent() const { return has_extent_; }
  /// Nothing where no light reaches the point.
  std::optional<Choice> choose(const LitPoint& point, float u) const {
    if (count_ == 1) return Choice{only_, 1};
    return choose_among_all(point, u);
  }
  float probability(const Light& light, const LitPoint& point) const;

 private:
  std::optional<Choice> choose_among_all(const LitPoint& point, float u) const;
  /// Of all at this point, that one of the tree is chosen.
  float tree_share(const LitPoint& point) const;

  std::vector<const Light*> lights_;  ///< of the scene; their places are the numbers of the tree
  size_t count_ = 0;                  ///< of those that are chosen at all
  const Light* only_ = nullptr;       ///< where that is one
  bool has_extent_ = false;
  LightTree tree_;
  std::vector<size_t> everywhere_;  ///< places of those that are chosen the same way everywhere
  std::vector<float> cumulative_;   ///< probabilities of these, one among another
  std::vector<float> probability_;  ///< the same by point; 0 for others
  float irradiance_ = 0;            ///< of these together
};

}  // namespace frond
