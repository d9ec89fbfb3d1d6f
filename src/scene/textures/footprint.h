#pragma once

#include "core/camera.h"
#include "core/material.h"

namespace frond {

/// How far apart the camera's samples fall on a surface, over which textures are filtered: an eighth of a pixel,
/// however many samples there are. One made by nothing does not filter. As if the camera looked at each point straight,
/// also where mirrors lie between: pbrt 4th ed., 10.1.
class Footprint {
 public:
  Footprint() = default;
  /// `between_samples`: over an eighth of a pixel; else of a whole one, where each has its samples at its centre.
  Footprint(const Camera& camera, const CameraPlacement& placement, bool between_samples = true);
  /// What textures may know of a hit that has its derivatives.
  void set(Hit& hit) const;

 private:
  /// From one sample to the next along an axis of the film.
  struct Step {
    Vec3 origin{INFINITY, INFINITY, INFINITY};     ///< camera space
    Vec3 direction{INFINITY, INFINITY, INFINITY};  ///< of a unit vector along z
  };
  Transform camera_from_world_;
  Step x_, y_;
  bool is_point_ = true;
};

}  // namespace frond
