#pragma once

#include "core/math/float4.h"

namespace frond {

/// Clamps each component to [0, 1]. NaN becomes 0.
inline Float4 clamped_to_unit(Float4 v) {
  constexpr Float4 kOne{1, 1, 1, 1};
  const Float4 positive = larger(Float4{}, v);
  return positive < kOne ? positive : kOne;
}

}  // namespace frond
