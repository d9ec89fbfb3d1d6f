#include "media/null_collisions.h"

#include "media/tracking.h"

namespace frond {
namespace {

/// A ray from a face of a box toward a random point inside it.
Ray ray_through(const Bounds& bounds, RandomStream& rng) {
  const auto point = [&bounds](const Vec3& share) {
    return Vec3{std::lerp(bounds.min.x, bounds.max.x, share.x), std::lerp(bounds.min.y, bounds.max.y, share.y),
                std::lerp(bounds.min.z, bounds.max.z, share.z)};
  };
  const int face = std::min(5, int(6 * rng.uniform()));
  const float side = face < 3 ? 0.f : 1.f, a = rng.uniform(), b = rng.uniform();
  const int axis = face % 3;
  const Vec3 from = point(axis == 0 ? Vec3{side, a, b} : axis == 1 ? Vec3{a, side, b} : Vec3{a, b, side});
  const float x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
  return {from, point({x, y, z}) - from};
}

}  // namespace

/// Paths that scatter meet real collisions, which end the count: where a medium is as dense as its majorant, there are
/// no null collisions.
void NullCollisionCheck::check(const Medium& medium, const WavelengthStrategy& wavelengths) const {
  // Rays and their numbers are fixed, so that the result does not depend on the seed of the render.
  constexpr int kRays = 8;
  constexpr uint64_t kKey = 0x6e756c6c;
  int64_t collisions = 0;
  StopPoll poll;
  for (int i = 0; i < kRays; ++i) {
    RandomStream rng(hash_key(kKey, uint64_t(i)));
    const Ray in_medium = ray_through(bounds_, rng);
    const Vec3 d = world_from_medium_.vector(in_medium.d);
    if (!(length(d) > 0)) continue;
    const Ray ray{world_from_medium_.point(in_medium.o), normalize(d)};
    const SampledWavelengths lambda = wavelengths.sample((float(i) + 0.5f) / kRays);
    // The majorant of the hero wavelength samples distances, as in the integrator.
    const int hero = i % lambda.count;
    SampledSpectrum unused;
    track(medium, ray, lambda, hero, rng.uniform(), rng, poll, unused,
          [&](const Vec3& p, const SampledSpectrum& majorant, const SampledSpectrum&) {
            const MediumPoint at = medium.properties(p, lambda);
            const bool is_real = rng.uniform() * majorant[hero] < at.sigma_a[hero] + at.sigma_s[hero];
            return !is_real && ++collisions <= int64_t{kMostNullCollisions} * kRays;
          });
    if (collisions > int64_t{kMostNullCollisions} * kRays)
      fail(where_,
           "a ray through this medium would have more than {} null collisions on average: its extinction coefficient "
           "is far below its largest value in most places; lower the scale, or the largest densities, or make the box "
           "smaller",
           kMostNullCollisions);
  }
}

}  // namespace frond
