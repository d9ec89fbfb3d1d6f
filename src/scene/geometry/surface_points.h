#pragma once

#include <map>
#include <span>
#include <vector>

#include "scene/geometry/shape_emitter.h"

namespace frond {

/// Point drawn from the surfaces of some materials.
struct RandomSurfacePoint {
  Vec3 p, ng;         ///< in the scene's space; `ng` is a unit vector on the front
  float extent = 0;   ///< as in Hit
  double weight = 0;  ///< area over the mean area of a point; 1 if the density is uniform. 0 where alpha is 0
};

/// Returns a uniform sample of an emitter's area under a map to the scene's space. `area`: mean area of a point.
RandomSurfacePoint surface_point(const ShapeEmitter& emitter, Vec2 u, const AffineMap& map, double area = 1);

/// Draws points from the surfaces of some materials, in all instances, nearly uniformly over their one-sided area. The
/// mean of the weights, times total(), is the area. Memory does not grow with the number of instances.
class SurfacePoints {
 public:
  /// `is_counted`: flags by material index. `geometry` must outlive this object.
  SurfacePoints(const Geometry& geometry, std::span<const uint8_t> is_counted);

  /// The area to which weights are relative: that of the surfaces if no map stretches them and no alpha cuts them.
  double total() const { return total_; }
  /// Returns the points with indices from `first`. Each depends on `key` and its index only. Throws Stopped, as the
  /// constructor does.
  std::vector<RandomSurfacePoint> draw(uint64_t key, uint64_t first, size_t count) const;

 private:
  /// Calls visit(emitter, map, factor on areas) for each counted surface.
  template <class Visit>
  void visit(const Visit& visit) const;

  const Geometry& geometry_;
  std::map<const Surface*, ShapeEmitter> emitters_;  ///< of the counted surfaces
  double total_ = 0;
};

}  // namespace frond
