#pragma once

#include <algorithm>
#include <cmath>

#include "scene/geometry/geometry.h"

namespace frond {

/// Instances of objects, as their callbacks need them.
struct GeometryInstances {
  /// Inverse maps are kept of so many instances at most: 64 MB.
  static constexpr size_t kMostKept = 1 << 20;

  const Instances& instances;
  std::vector<const GeometryObject*> objects;  ///< by row; a single one: the same for all
  uint64_t first_id = 0;           ///< of what the first row holds, in the object that these instances are part of
  std::vector<uint64_t> ids = {};  ///< by row, from first_id; empty: all rows hold as many
  std::vector<AffineMap::Inverse> inverses = {};  ///< of the table's maps; empty: they are made when they are needed
  AffineMap::Inverse from_placement = {};         ///< where there is one

  const GeometryObject& object(size_t row) const { return *objects[objects.size() == 1 ? 0 : row]; }
  /// `made`: where it is put if it is not kept.
  const AffineMap::Inverse& inverse(size_t row, AffineMap::Inverse& made) const {
    return inverses.empty() ? made = instances.table->map(row).inverse() : inverses[row];
  }
};

/// What stands together, as Embree and we know it.
struct GeometryObject {
  ObjectParts parts;
  std::vector<GeometryInstances> instances = {};
  embree::Scene scene = {};
  Bounds bounds = {};              ///< a little wider than it is
  std::vector<Vec3> outline = {};  ///< it lies within the hull of these points
  /// How many ids an instance of it takes: one for each instance in it that holds no others, and one for its own
  /// surfaces.
  uint64_t ids = 1;
  uint32_t depth = 0;  ///< of instances in it
  /// All that it is, where that is one analytic primitive: then nothing has to be traversed.
  const Surface* only_primitive = nullptr;
};

inline float largest_coordinate(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// By as much as rounding may have moved what lies within.
inline Bounds widened(const Bounds& b) {
  const float slack = 0x1p-20f * std::max(largest_coordinate(b.min), largest_coordinate(b.max));
  const Vec3 by{slack, slack, slack};
  return {b.min - by, b.max + by};
}

}  // namespace frond
