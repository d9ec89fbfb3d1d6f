#pragma once

#include "core/float4.h"

namespace frond {

/// To [0, 1], number by number.
inline Float4 clamped_to_unit(Float4 v) {
  constexpr Float4 kOne{1, 1, 1, 1};
  const Float4 positive = larger(Float4{}, v);
  return positive < kOne ? positive : kOne;
}

}  // namespace frond
