#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/random.h"
#include "core/spectrum.h"
#include "scene/math/affine_map.h"

namespace frond {

/// How leaves lean: a distribution of the angle between a leaf's normal and the vertical.
struct LeafAngles {
  std::string_view name;
  /// Density over the angle (radians, 0 to pi/2), up to a factor.
  double (*density)(double theta);
};
/// Those of de Wit 1965 as Goel and Strebel 1984 write them (Agronomy Journal 76:800-802), and the spherical one.
std::span<const LeafAngles> leaf_angle_distributions();

/// Leaves at random in a layer, or in a ball.
struct HomogeneousCanopy {
  double leaf_area_index = 3;              ///< one-sided area of leaves over that of ground
  uint64_t count = 0;                      ///< of leaves, in place of what the leaf area index asks for
  const LeafAngles* angles = nullptr;      ///< azimuths are even
  double leaf_area = 3.14159265358979323;  ///< of the object that is copied, at scale 1: that of a unit disk
  double scale = 0.05;                     ///< of each instance
  std::array<double, 2> size = {10, 10};   ///< of the plot, along x and y
  std::array<double, 2> heights = {0, 1};  ///< of the leaves' middles
  double ball = 0;                         ///< radius of a ball around the origin, in place of the plot; 0: the plot
  double apart = 0;                        ///< least distance of leaves' middles; 0: none knows of another
  /// Numbers that textures may ask for, even between two bounds.
  struct Column {
    std::string name;
    Interval range;
  };
  std::vector<Column> columns = {};
  uint64_t seed = 0;

  /// To the nearest whole one.
  uint64_t leaves() const;
};

/// Draws leaves, one after the other: the same ones of the same seed.
class LeafPlacer {
 public:
  explicit LeafPlacer(const HomogeneousCanopy& canopy);
  /// The next leaf; its columns' numbers go into `values`. Throws InputError where there is no room for it.
  AffineMap place(std::span<float> values);

 private:
  using Cell = std::array<int64_t, 3>;
  struct CellHash {
    size_t operator()(const Cell& c) const { return hash_key(uint64_t(c[0]), c[1], c[2]); }
  };

  Vec3d position(RandomStream& random) const;
  /// Whether leaves that are there leave room; then one is there.
  bool takes_room(const Vec3d& p);
  Cell cell_of(const Vec3d& p) const;

  const HomogeneousCanopy& canopy_;
  std::vector<double> angle_at_;                                  ///< quantiles of the leaf angle
  std::unordered_map<Cell, std::vector<Vec3d>, CellHash> there_;  ///< where leaves keep apart
  uint64_t next_ = 0;
};

}  // namespace frond
