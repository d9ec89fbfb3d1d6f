#pragma once

#include "core/camera.h"
#include "core/material.h"

namespace frond {

/// Approximates the distance between camera samples on a surface, over which textures are filtered: an eighth of a
/// pixel, independent of the number of samples. The camera is assumed to see each point directly, also behind mirrors
/// (pbrt 4th ed., 10.1). A default-constructed footprint does not filter.
class Footprint {
 public:
  Footprint() = default;
  /// `between_samples`: an eighth of a pixel; otherwise a whole pixel, for samples at pixel centres.
  Footprint(const Camera& camera, const CameraPlacement& placement, bool between_samples = true);
  /// Sets the footprint of a hit that has derivatives.
  void set(Hit& hit) const;

 private:
  /// Change of a camera ray from one sample to the next along an axis of the film.
  struct Step {
    Vec3 origin{INFINITY, INFINITY, INFINITY};     ///< camera space
    Vec3 direction{INFINITY, INFINITY, INFINITY};  ///< relative to a unit vector along z
  };
  Transform camera_from_world_;
  Step x_, y_;
  bool is_point_ = true;
};

}  // namespace frond
