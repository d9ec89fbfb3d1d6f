#pragma once

#include <limits>

#include "core/vec.h"

namespace frond {

/// Ray from `o` along `d`; intersections lie at o + t d with 0 < t < t_max. `d` need not be normalized.
struct Ray {
  Vec3 o, d;
  float t_max = std::numeric_limits<float>::infinity();
};

}  // namespace frond
