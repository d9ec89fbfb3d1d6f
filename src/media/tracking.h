#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/random.h"
#include "core/medium.h"
#include "core/spectrum.h"
#include "core/stop.h"

namespace frond {

/// exp(-sigma d) in each lane; 1 where sigma is 0, also over an infinite distance.
inline SampledSpectrum beer_lambert(const SampledSpectrum& sigma, float d) {
  d = std::min(d, std::numeric_limits<float>::max());
  SampledSpectrum t;
  for (int i = 0; i < kLanes; ++i) t[i] = std::exp(-sigma[i] * d);
  return t;
}

/// Delta tracking along a ray in a medium (Woodcock et al. 1965): at each tentative collision calls `collide(point,
/// majorant, transmittance)` with the transmittance of the majorants since the last call, and ends if it returns false.
/// Returns true at the end of the ray; `transmittance` is then the transmittance of the majorants since the last
/// collision. `u` samples the first distance. A majorant far above the density makes any number of collisions: each one
/// counts for `poll`.
template <class Collide>
bool track(const Medium& medium, const Ray& ray, const SampledWavelengths& lambda, int hero, float u, RandomStream& rng,
           StopPoll& poll, SampledSpectrum& transmittance, const Collide& collide) {
  MajorantSteps steps = medium.majorants(ray, lambda);
  transmittance = SampledSpectrum(1);
  MajorantSteps::Step step;
  float depth = -std::log(1 - u);  // optical depth of the majorant to the next collision
  while (steps.next(step)) {
    const float sigma = step.sigma[hero], reach = step.end - step.begin;
    // Distance in this step, in double precision: in a dense medium far from the ray's origin the distance between two
    // collisions is less than the spacing of floats there.
    double at = 0;
    for (;;) {
      const double t = sigma > 0 ? at + double(depth / sigma) : double(INFINITY);
      if (!(t < double(reach))) break;
      transmittance *= beer_lambert(step.sigma, float(t - at));
      if (!collide(ray.o + ray.d * float(double(step.begin) + t), step.sigma, transmittance)) return false;
      poll();
      transmittance = SampledSpectrum(1);
      depth = -std::log(1 - rng.uniform());
      at = t;
    }
    const float rest = float(double(reach) - at);
    if (sigma > 0) depth = std::max(0.f, depth - sigma * rest);
    transmittance *= beer_lambert(step.sigma, rest);
  }
  return true;
}

}  // namespace frond
