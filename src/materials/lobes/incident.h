#pragma once

#include <cstdint>

namespace frond {

/// What a leaf's model, which is not reciprocal, takes for its incident ray.
enum class Incident : uint8_t {
  traced,      ///< wo, the one that a path arrives along: as published
  light,       ///< wi
  reciprocal,  ///< none: the reciprocal leaf nearest to the model (docs/reciprocal_leaf.md)
};

}  // namespace frond
