#pragma once

#include <new>

#include "core/math/ray.h"
#include "core/math/transform.h"
#include "core/plugin.h"

namespace frond {

/// Camera: generates rays for points of the film. Thread-safe.
class Camera {
 public:
  virtual ~Camera() = default;
  /// Ray in world space, with unit direction, through the point `film` (in pixels, y down), for a uniform sample `lens`
  /// of the lens in [0, 1)^2.
  virtual Ray ray(Vec2 film, Vec2 lens) const = 0;
  /// Constructs the rays of `count` points: exactly those of `ray`. A camera overrides it where that is faster.
  virtual void rays(const Vec2* film, const Vec2* lens, int count, Ray* to) const {
    // In place: copying a ray right after its members were written would stall on store forwarding.
    for (int i = 0; i < count; ++i) ::new (to + i) Ray(ray(film[i], lens[i]));
  }
  /// True if `ray` depends on `lens`.
  virtual bool uses_lens() const = 0;
  /// True if neighbouring pixels are unrelated views, such as a list of view directions: a filter must not mix them.
  virtual bool pixels_are_apart() const { return false; }
};

/// Placement and resolution of a camera.
struct CameraPlacement {
  Transform world_from_camera;
  int width, height;  ///< full resolution, pixels
};

/// Plug-in record of a camera.
struct CameraInfo : PluginInfo {
  /// Returns a camera, not null. Throws InputError.
  std::unique_ptr<Camera> (*make)(const Params&, const CameraPlacement&);
};

}  // namespace frond
