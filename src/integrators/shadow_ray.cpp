#include "integrators/shadow_ray.h"

#include "integrators/path_parts.h"

namespace frond {

/// Only media and surfaces without a BSDF transmit light, as in pbrt-v4.
bool ShadowRay::trace(const LightSample& sample, uint64_t key, Arena& arena, uint64_t& rays) {
  const bool is_distant = std::isinf(sample.distance);
  const Vec3 end = is_distant ? Vec3{} : origin_.p + sample.wi * sample.distance;
  Vec3 from = origin_.p, o = origin_.p + origin_.offset;
  RandomStream rng(hash_key(key, uint64_t{1}));
  float travelled = 0;
  SurfacePoint point;
  for (int passed = 0; passed < kMostPassed; ++passed) {
    Ray ray{o, sample.wi, INFINITY, time_};
    if (!is_distant) {
      const float rest = length(end - o);
      ray.d = (end - o) / rest;
      ray.t_max = rest * kBeforeLight;
    }
    ++rays;
    poll_();
    const bool is_hit = world_.intersect(ray, hash_key(key, uint64_t(passed)), point);
    if (is_hit) {
      arena.reset();
      const auto bsdf = [&] { return point.material->evaluate(point.hit, lambda_, arena); };
      if (name_material_in_errors(point, bsdf)) return false;
    }
    // An unbounded medium attenuates distant lights over the diameter of the scene, as in pbrt-v4.
    const float distance = is_hit       ? length(point.hit.p - from)
                           : is_distant ? std::max(0.f, 2 * world_.radius() - travelled)
                                        : length(end - from);
    if (medium_ && !attenuate({from, ray.d, distance}, rng)) return false;
    if (!is_hit) return true;
    travelled += distance;
    medium_ = medium_beyond(world_, point, ray.d, medium_);
    from = point.hit.p;
    o = offset_origin(point.hit, ray.d);
  }
  return false;
}

/// Ratio tracking (Novak et al. 2014); in a homogeneous medium the transmittance itself, with probability 1.
bool ShadowRay::attenuate(const Ray& ray, RandomStream& rng) {
  if (medium_->is_homogeneous()) {
    MajorantSteps steps = medium_->majorants(ray, lambda_);
    MajorantSteps::Step step;
    while (steps.next(step)) {
      const SampledSpectrum t = beer_lambert(step.sigma, step.end - step.begin);
      path_.multiply(t, t, SampledSpectrum(1));
    }
    return !path_.beta.is_black();
  }
  const int h = path_.hero;
  SampledSpectrum t;
  const auto collide = [&](const Vec3& p, const SampledSpectrum& majorant, const SampledSpectrum& t_maj) {
    const SampledSpectrum null = null_coefficient(majorant, medium_->properties(p, lambda_));
    const SampledSpectrum scaled = t_maj * (1 / (t_maj[h] * majorant[h]));
    path_.multiply(scaled * null, scaled * null, scaled * majorant);
    constexpr float kLow = 0.05f, kEnd = 0.75f;  // Russian roulette, as in pbrt-v4
    const float sum = mean(path_.r_l + path_.r_u, lambda_);
    if (!(path_.beta.max() > 0) || !(sum > 0)) return false;
    if (path_.beta.max() < kLow * sum) {
      if (rng.uniform() < kEnd) return false;
      path_.beta *= 1 / (1 - kEnd);
    }
    return true;
  };
  const float u = rng.uniform();
  if (!track(*medium_, ray, lambda_, h, u, rng, poll_, t, collide)) return false;
  if (!(t[h] > 0)) return false;
  path_.multiply(t * (1 / t[h]), t * (1 / t[h]), t * (1 / t[h]));
  return true;
}

}  // namespace frond
