#pragma once

#include <limits>

#include "core/vec.h"

namespace frond {

/// Half-line from `o` along `d`; hits lie at o + t d, 0 < t < t_max. `d` need not be unit.
struct Ray {
  Vec3 o, d;
  float t_max = std::numeric_limits<float>::infinity();
};

}  // namespace frond
