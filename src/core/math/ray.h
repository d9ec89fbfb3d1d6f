#pragma once

#include <limits>

#include "core/math/vec.h"

namespace frond {

/// Ray from `o` along `d`; intersections lie at o + t d with 0 < t < t_max. `d` need not be normalized. Rays that
/// continue a path have its `time`.
struct Ray {
  Vec3 o, d;
  float t_max = std::numeric_limits<float>::infinity();
  float time = 0;  ///< moment at which the ray sees moving things, from 0 (the shutter opens) to 1 (it closes)
};

}  // namespace frond
