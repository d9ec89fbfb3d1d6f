#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/math/precise_transform.h"
#include "core/math/random.h"
#include "core/spectrum.h"
#include "scene/geometry/leaf_angles.h"

namespace frond {

/// Solid that is filled with leaves at a uniform density.
struct Crown {
  enum class Shape : uint8_t { ellipsoid, cone, cylinder };
  Vec3d centre;                    ///< at the middle of its height
  Vec3d radii;                     ///< half axes along x and y, of a cone at its base, and half of the height
  Shape shape = Shape::ellipsoid;  ///< the apex of a cone is up
  double density = 1;              ///< leaf area density relative to that of other crowns

  double volume() const;
};

/// Rows along y, the first half a spacing from x = 0.
struct PlantRows {
  double spacing, width;
};

/// A canopy of randomly placed leaves in a layer, in rows, in crowns, or in a ball.
struct RandomCanopy {
  double leaf_area_index = 3;                ///< one-sided leaf area over ground area
  uint64_t count = 0;                        ///< number of leaves, instead of leaf_area_index; 0: not given
  const LeafAngles* angles = nullptr;        ///< azimuths are uniform
  double leaf_area = 3.14159265358979323;    ///< one-sided area of the object at scale 1; default: a unit disk
  double scale = 0.05;                       ///< of each instance
  std::array<double, 2> size = {10, 10};     ///< of the plot, along x and y
  std::array<double, 2> heights = {0, 1};    ///< of the leaves' centres
  double ball = 0;                           ///< radius of a ball around the origin, instead of a plot; 0: plot
  std::optional<DensityTable> profile = {};  ///< leaf area density by height, instead of heights
  std::optional<PlantRows> rows = {};        ///< positions along x; empty: anywhere
  std::vector<Crown> crowns = {};            ///< instead of heights; empty: the whole plot
  double apart = 0;                          ///< minimum distance between leaves' centres; 0: independent positions
  /// A random number of each leaf, uniform in `range`, for Texture "instance".
  struct Column {
    std::string name;
    Interval range;
  };
  std::vector<Column> columns = {};
  uint64_t seed = 0;

  /// Returns the number of leaves, rounded to the nearest integer.
  uint64_t leaves() const;
  /// Returns the largest absolute value of the coordinates of leaves.
  double largest_position() const;
};

/// Generates leaves one by one. Equal seeds give equal leaves.
class LeafPlacer {
 public:
  explicit LeafPlacer(const RandomCanopy& canopy);
  /// Returns the next of the canopy's leaves and sets its columns' values. Throws InputError if there is no free
  /// position for it.
  PreciseTransform::Rows place(std::span<float> values);

 private:
  using Cell = std::array<int64_t, 3>;
  struct CellHash {
    size_t operator()(const Cell& c) const { return hash_key(uint64_t(c[0]), c[1], c[2]); }
  };

  Vec3d position(RandomStream& random) const;
  Vec3d position_in_crown(RandomStream& random) const;
  /// Whether the position is far enough from all earlier leaves; if so, it is recorded.
  bool try_to_place(const Vec3d& p);
  Cell cell_of(const Vec3d& p) const;

  const RandomCanopy& canopy_;
  uint64_t leaves_;                                               ///< number of leaves of the canopy
  std::vector<double> crown_ends_;                                ///< share of the leaves up to the end of each crown
  std::vector<double> angle_at_;                                  ///< quantiles of the leaf angle
  std::unordered_map<Cell, std::vector<Vec3d>, CellHash> there_;  ///< positions by cell, if leaves keep a distance
  uint64_t next_ = 0;
};

}  // namespace frond
