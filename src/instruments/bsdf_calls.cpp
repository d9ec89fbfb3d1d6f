#include "instruments/bsdf_calls.h"

#include <cassert>
#include <numbers>

#include "core/math/sampling.h"

namespace frond {

std::vector<float> benchmark_wavelengths(int lanes) {
  assert(lanes >= 1 && lanes <= kLanes);
  switch (lanes) {
    case 1:
      return {551};
    case 2:
      return {608, 551};
    case 3:
      return {608, 551, 455};
    default:
      return {430, 500, 570, 640};
  }
}

Vec3 view_direction(double theta_deg) {
  const double theta = theta_deg * std::numbers::pi / 180;
  return {static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
}

CallDraws::CallDraws() {
  RandomStream rng(1);
  for (Draw& draw : draws_) {
    const float z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
    draw.wi = {r * std::cos(phi), r * std::sin(phi), z};
    draw.uc = rng.uniform();
    draw.u = {rng.uniform(), rng.uniform()};
    draw.wo = sample_cosine_hemisphere({rng.uniform(), rng.uniform()});
    if (rng.uniform() < 0.5f) draw.wo.z = -draw.wo.z;
  }
}

}  // namespace frond
