#pragma once

#include <algorithm>
#include <cmath>

#include "scene/geometry/geometry.h"
#include "scene/geometry/huge_pages.h"

namespace frond {

/// Data of instances for Embree's callbacks.
struct GeometryInstances {
  /// Up to this number of instances, inverse maps are stored (1 GB); beyond it they are computed for each ray.
  static constexpr size_t kMostKept = 1 << 24;

  const Instances& instances;
  std::vector<const GeometryObject*> objects;  ///< by row; a single element applies to all rows
  uint64_t first_id = 0;                       ///< first instance number, within the containing object
  std::vector<uint64_t> ids = {};              ///< by row, relative to first_id; empty: all rows contain equally many
  /// Of the table's maps; empty: computed on demand.
  std::vector<AffineMap::Inverse, HugePages<AffineMap::Inverse>> inverses = {};
  AffineMap::Inverse from_placement = {};  ///< valid if instances.is_placed

  /// Number of equal parts of the exposure between Embree's time steps.
  unsigned parts() const {
    unsigned parts = 1;
    for (const Motion& motion : instances.motions) parts = std::max(parts, motion.parts());
    return parts;
  }
  const GeometryObject& object(size_t row) const { return *objects[objects.size() == 1 ? 0 : row]; }
  /// `made`: storage for an inverse that is computed on demand.
  const AffineMap::Inverse& inverse(size_t row, float time, AffineMap::Inverse& made) const {
    return inverses.empty() ? made = instances.map(row, time).inverse() : inverses[row];
  }
};

/// An object: its parts and its Embree scene.
struct GeometryObject {
  ObjectParts parts;
  std::vector<GeometryInstances> instances = {};
  std::vector<embree::Scene> small_meshes = {};  ///< scenes within `scene`: Geometry::attach
  embree::Scene scene = {};
  Bounds bounds = {};              ///< slightly enlarged, for rounding errors
  std::vector<Vec3> outline = {};  ///< the object lies within the convex hull of these points
  /// Number of instance numbers that an instance of the object takes: one for each contained instance without further
  /// instances, and one for the object's own surfaces.
  uint64_t ids = 1;
  float stretch = 1;   ///< largest factor of coordinates from the object's space to the spaces of contained objects
  uint32_t depth = 0;  ///< nesting depth of the contained instances
  /// The object's only primitive if it is analytic: no traversal is needed then.
  const Surface* only_primitive = nullptr;
};

/// Returns the bounds enlarged by the possible rounding error of points within. Empty bounds stay empty.
inline Bounds widened(const Bounds& b) {
  if (b.is_empty()) return b;
  const float slack = 0x1p-20f * std::max(largest_coordinate(b.min), largest_coordinate(b.max));
  const Vec3 by{slack, slack, slack};
  return {b.min - by, b.max + by};
}

}  // namespace frond
