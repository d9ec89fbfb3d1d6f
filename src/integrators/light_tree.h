#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/light.h"

namespace frond {

/// Lights of known bounds in a binary tree of clusters, to choose one by what it may give at a point in a time that
/// grows with the logarithm of their number (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting").
class LightTree {
 public:
  struct Entry {
    uint32_t light;  ///< a number, given back by `choose`
    LightBounds bounds;
    double power;  ///< positive
  };
  struct Choice {
    uint32_t light;
    float probability;
  };

  LightTree() = default;
  explicit LightTree(std::vector<Entry> entries);

  bool empty() const { return nodes_.empty(); }
  /// An estimate, from above, of the irradiance at a point of a surface, on either side; 0 only where nothing arrives.
  float importance(const Vec3& p, const Vec3& n) const { return empty() ? 0 : importance(nodes_[0], p, n); }
  /// By a uniform number in [0, 1). Nothing where no light reaches the point.
  std::optional<Choice> choose(const Vec3& p, const Vec3& n, float u) const;
  /// Of `choose`, for the light with this number.
  float probability(const Vec3& p, const Vec3& n, uint32_t light) const;

 private:
  struct Node {
    LightBounds bounds;
    float intensity = 0;  ///< of all its lights together, where they face
    uint32_t second = 0;  ///< place of the second child, the first follows its parent; 0: a leaf
    uint32_t light = 0;   ///< of a leaf
  };

  static float importance(const Node& node, const Vec3& p, const Vec3& n);
  uint32_t build(std::span<Entry> entries, uint64_t trail, int depth);

  std::vector<Node> nodes_;
  std::vector<uint64_t> trails_;  ///< by light: its way down, bit by bit; 1: the second child
};

}  // namespace frond
