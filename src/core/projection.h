#pragma once

#include <array>

namespace frond {

/// Interface that a Camera has in addition if a matrix projects the scene to its film.
class Projection {
 public:
  using Matrix = std::array<std::array<double, 4>, 4>;  ///< by rows, for column vectors

  virtual ~Projection() = default;
  /// From camera space to pbrt-v4's screen space: the shorter axis of the film is -1 to 1, y is up, and z is 0 at the
  /// near plane and 1 at the far one.
  virtual Matrix screen_from_camera() const = 0;
};

}  // namespace frond
