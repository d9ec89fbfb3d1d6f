#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/light.h"

namespace frond {

/// Binary tree of clusters of lights with known bounds. Draws one light by an estimate of its irradiance at a point, in
/// a time that grows with the logarithm of the number of lights (Conty Estevez and Kulla 2018, "Importance Sampling of
/// Many Lights with Adaptive Tree Splitting").
class LightTree {
 public:
  /// A light for the tree; bounds in world space.
  struct Entry {
    uint32_t light;  ///< index that `choose` returns
    LightBounds bounds;
    double power;  ///< positive, in any unit
  };
  /// A light's index and the probability with which it was drawn.
  struct Choice {
    uint32_t light;
    float probability;
  };

  LightTree() = default;
  explicit LightTree(std::vector<Entry> entries);

  bool empty() const { return nodes_.empty(); }
  /// Conservative estimate of the irradiance at a surface point, on either side, relative to the entries' power; 0 only
  /// if no light arrives.
  float importance(const Vec3& p, const Vec3& n) const { return empty() ? 0 : importance(nodes_[0], p, n); }
  /// Draws a light by `u` in [0, 1), and leaves in `u` its place within the light's share of [0, 1), from 0 to 1;
  /// nothing if no light reaches the point.
  std::optional<Choice> choose(const Vec3& p, const Vec3& n, float& u) const;
  /// Probability with which `choose` draws this light; 0 if it is not in the tree.
  float probability(const Vec3& p, const Vec3& n, uint32_t light) const;

 private:
  struct Node {
    LightBounds bounds;
    float intensity = 0;  ///< sum of its lights' intensities in the direction that they face
    uint32_t second = 0;  ///< index of the second child; the first follows its parent; 0: a leaf
    uint32_t light = 0;   ///< of a leaf node
  };

  static float importance(const Node& node, const Vec3& p, const Vec3& n);
  uint32_t build(std::span<Entry> entries, uint64_t trail, int depth);

  std::vector<Node> nodes_;
  std::vector<uint64_t> trails_;  ///< by light: path from the root, a bit per level; 1: the second child
};

}  // namespace frond
