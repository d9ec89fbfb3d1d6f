#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "core/world.h"
#include "integrators/light_tree.h"

namespace frond {

/// Selects one light of the scene for light sampling at a surface point.
class LightSelector {
 public:
  /// Probability of a light: equal, in proportion to its power, or by a light tree.
  enum class Strategy : uint8_t {
    uniform,
    power,
    tree,  ///< by an estimate of each light's irradiance at the point (LightTree)
  };
  /// A light and the probability with which it was drawn.
  struct Choice {
    const Light* light;
    float probability;
  };
  /// Position and unit geometric normal of a surface point, world space; a point of a medium has the normal 0.
  struct LitPoint {
    Vec3 p, n;
  };

  LightSelector() = default;
  /// `world` must outlive the selector.
  LightSelector(const World& world, Strategy strategy);

  /// Whether no light is sampled.
  bool empty() const { return count_ == 0; }
  /// Whether there is more than one light, so that `choose` uses `u`.
  bool has_choice() const { return count_ > 1; }
  /// Whether some light has points or directions to sample: all except delta lights, including emitting surfaces that
  /// no ray can hit.
  bool has_extent() const { return has_extent_; }
  /// Draws a light by `u` in [0, 1); nothing if no light reaches the point. Afterwards `u` is a number in [0, 1) for a
  /// sample of this light: numbers that are evenly spread over all lights remain so for each light. The choice consumes
  /// the high bits of the 24 of `u`; `low_bits`, a second number in [0, 1), supplies low ones.
  std::optional<Choice> choose(const LitPoint& point, float& u, float low_bits) const {
    if (count_ == 1) return Choice{only_, 1};
    const auto choice = choose_among_all(point, u);
    if (choice) {
      const float rest = u + low_bits * 0x1p-24f / choice->probability;
      u = rest - std::floor(rest);
    }
    return choice;
  }
  /// Probability with which `choose` draws this light at the point.
  float probability(const Light& light, const LitPoint& point) const;

 private:
  std::optional<Choice> choose_among_all(const LitPoint& point, float& u) const;
  /// Probability at this point that a light of the tree is drawn.
  float tree_share(const LitPoint& point) const;

  std::vector<const Light*> lights_;  ///< all lights of the scene, by their index in the tree
  size_t count_ = 0;                  ///< number of lights that are sampled
  const Light* only_ = nullptr;       ///< the light, if that number is one
  bool has_extent_ = false;
  LightTree tree_;
  std::vector<size_t> outside_tree_;  ///< indices of lights whose probability does not depend on the point
  std::vector<float> cumulative_;     ///< cumulative probabilities of these among each other
  std::vector<float> probability_;    ///< the same by light, not cumulative; 0 for others
  float irradiance_ = 0;              ///< sum of these lights' irradiances
};

}  // namespace frond
