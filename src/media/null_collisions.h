#pragma once

#include "core/error.h"
#include "core/medium.h"

namespace frond {

/// Largest mean number of null collisions of a ray through a medium: more make images impossible, not only slow.
inline constexpr int kMostNullCollisions = 100'000;

/// Box and place of a medium, for the check of its majorants.
class NullCollisionCheck {
 public:
  /// `where`: of the medium.
  NullCollisionCheck(const Bounds& bounds, const Transform& world_from_medium, Location where)
      : bounds_(bounds), world_from_medium_(world_from_medium), where_(std::move(where)) {}

  /// Traces some rays through the box by delta tracking. Throws InputError if their mean number of null collisions is
  /// above kMostNullCollisions.
  void check(const Medium& medium, const WavelengthStrategy& wavelengths) const;

 private:
  Bounds bounds_;  ///< medium space
  Transform world_from_medium_;
  Location where_;
};

}  // namespace frond
