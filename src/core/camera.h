#pragma once

#include "core/plugin.h"
#include "core/ray.h"
#include "core/transform.h"

namespace frond {

/// Rays from film points.
class Camera {
 public:
  virtual ~Camera() = default;
  /// World-space ray, unit direction, through the film at `film` (pixels, y down); `lens` in [0, 1)^2.
  virtual Ray ray(Vec2 film, Vec2 lens) const = 0;
  virtual bool uses_lens() const = 0;
  /// What its pixels see has nothing to do with what their neighbours do: a filter must not mix them.
  virtual bool pixels_are_apart() const { return false; }
};

struct CameraPlacement {
  Transform world_from_camera;
  int width, height;  ///< full resolution, pixels
};

struct CameraInfo : PluginInfo {
  std::unique_ptr<Camera> (*make)(const Params&, const CameraPlacement&);
};

}  // namespace frond
