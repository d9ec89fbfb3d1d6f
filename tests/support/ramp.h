#pragma once

#include <algorithm>

#include "core/texture.h"

namespace frond::test {

/// From `low` at u = 0 to `high` at u = 1.
class Ramp final : public FloatTexture {
 public:
  Ramp(float low, float high) : low_(low), high_(high) {}
  float evaluate(const TexturePoint& at) const override { return low_ + at.uv.x * (high_ - low_); }
  Interval range() const override { return {double(std::min(low_, high_)), double(std::max(low_, high_))}; }

 private:
  float low_, high_;
};

}  // namespace frond::test
