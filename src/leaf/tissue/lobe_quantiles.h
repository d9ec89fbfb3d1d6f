#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/math/float4.h"

namespace frond::leaf {

/// Inverse of F(s), the integral of (1 - s^2)^(a - 1) from -1 to s, divided by that from -1 to 1. Cubics between nodes
/// that are even in each octave of 1 - F, since 1 - s is about a power of it there. Error 1e-6, except for the
/// outermost 2^-24 of either end.
class PowerQuantile {
 public:
  /// a > 0.
  explicit PowerQuantile(double a);

  /// A sine s and its cosine.
  struct Angle {
    float sine, cosine;
  };
  /// Returns the s at which F is `share`, in [0, 1].
  Angle at(float share) const {
    const float beyond = 2 * std::min(share, 1 - share);
    const auto bits = std::bit_cast<uint32_t>(std::max(beyond, kLeast));
    const Float4& c = cells_[(bits >> kBitsInside) - kFirstCell];
    const float t = static_cast<float>(bits & ((1u << kBitsInside) - 1)) * (1.f / (1u << kBitsInside));
    // x^2 = 1 - |s|: keeps the digits of the cosine.
    const float x = c[0] + t * (c[1] + t * (c[2] + t * c[3])), x2 = x * x;
    return {std::copysign(1 - x2, share - 0.5f), x * std::sqrt(2 - x2)};
  }

 private:
  static constexpr float kLeast = 0x1p-24f;
  static constexpr uint32_t kBitsInside = 20;  ///< of a float, below the eight cells of an octave
  static constexpr uint32_t kFirstCell = std::bit_cast<uint32_t>(kLeast) >> kBitsInside;

  std::vector<Float4> cells_;  ///< of x over the cell: powers 0 to 3
};

/// Draws directions of a lobe cos^e that is cut by a plane, without rejection. A direction has an elevation beta over
/// the plane that the axis and the normal span, and its projection into that plane is at psi from the axis: cos alpha =
/// cos beta cos psi, the solid angle is cos beta dbeta dpsi, and the cut is at one psi for every beta. So both angles
/// are independent, and the densities of their sines are (1 - s^2) to the powers e / 2 and (e - 1) / 2.
struct LobeQuantiles {
  explicit LobeQuantiles(double exponent) : across(exponent / 2 + 1), along(exponent / 2 + 0.5) {}
  PowerQuantile across, along;
};

}  // namespace frond::leaf
