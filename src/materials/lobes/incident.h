#pragma once

#include <cstdint>

namespace frond {

/// Incident direction of a leaf model, which is not reciprocal by itself.
enum class Incident : uint8_t {
  traced,      ///< wo, which a path arrives along: as published
  light,       ///< wi
  reciprocal,  ///< neither: the reciprocal leaf closest to the model (docs/leaf_models.md)
};

}  // namespace frond
