#pragma once

#include <array>
#include <span>

#include "core/math/affine_map.h"
#include "core/math/ray.h"
#include "core/units/interval.h"

namespace frond {

/// Motion between two transforms, as in pbrt-v4: translation, rotation (polar decomposition, slerp the shorter way) and
/// what is left are interpolated apart. So a moved point takes the chord where a rotation comes before a translation.
class Motion {
 public:
  /// `seen`: shares of the motion when the shutter opens and when it closes; before share 0 and after share 1 nothing
  /// moves. Both maps must be invertible; problem_of_motion must be empty.
  Motion(const AffineMap& start, const AffineMap& end, Interval seen);

  /// Returns the map at a ray's time, from 0 to 1.
  AffineMap at(float time) const;
  /// Whether `at` differs within the exposure.
  bool is_still() const;
  /// Number of equal parts of the exposure within which `deviation` is small compared with the motion.
  unsigned parts() const;
  /// Bound of the distance of a moved point from the chord, within one of `parts` parts of the exposure. `size`:
  /// largest length of the points before the motion.
  float deviation(unsigned parts, float size) const;

 private:
  static constexpr unsigned kMostParts = 32;
  /// Stretch: the part of a map without translation and rotation, by rows.
  using Stretch = std::array<Vec3, 3>;

  float share(float time) const;
  /// Whether the motion begins or ends within the exposure.
  bool has_corner() const;

  Interval seen_;
  std::array<Vec3, 2> translation_;
  /// Unit quaternions, w last: the start's, and the one orthogonal to it in the plane of the start's and the end's. A
  /// rotation is their sum, weighted by the cosine and the sine of a share of angle_.
  std::array<std::array<float, 4>, 2> rotation_{};
  float angle_ = 0;  ///< between the quaternions of start and end, radians: half of the rotation's angle, at most pi/2
  std::array<Stretch, 2> stretch_{};
};

/// Returns the reason why there is no motion from one invertible map to the other; "" if there is one.
std::string problem_of_motion(const AffineMap& start, const AffineMap& end);

/// Motion of a camera that makes its rays for the start of the motion.
class CameraMotion {
 public:
  /// Arguments as for Motion, of the world-from-camera transforms.
  CameraMotion(const AffineMap& start, const AffineMap& end, Interval seen)
      : motion_(start, end, seen), from_start_(start.inverse()) {}
  /// Moves a ray, by its time. The direction is a unit vector again.
  void move(Ray& ray) const;

 private:
  Motion motion_;
  AffineMap::Inverse from_start_;
};

}  // namespace frond
