#include "leaf/fluorescence/fluorescence_walk.h"

#include <cmath>
#include <numbers>

#include "core/stop.h"
#include "leaf/walk/walker.h"

namespace frond::leaf {
namespace {

/// Share of the medium's thickness between its upper boundary and the point where a ray is absorbed that passes it.
double absorption_depth(const Walker<1>& ray, RandomStream& rng) {
  const double attenuation = ray.attenuation(), uniform = rng.uniform_double();
  // The exponential distribution of free paths, truncated at the far boundary.
  const double passed = std::min(1.0, -std::log1p(uniform * std::expm1(-attenuation)) / attenuation);
  return ray.up() ? 1 - passed : passed;
}

Vec3d isotropic(RandomStream& rng) {
  const double z = 2 * rng.uniform_open() - 1, phi = 2 * std::numbers::pi * rng.uniform_double();
  const double sine = std::sqrt((1 - z) * (1 + z));
  return {sine * std::cos(phi), sine * std::sin(phi), z};
}

/// Follows light from `wi` at the wavelength of excitation. Calls emit(ray, weight) for each absorption, while the ray
/// stands before the medium that absorbs it. Weights contain the transmittance of the outer surface.
template <class Emit>
void excite(const FluorescingTissue& leaf, const Vec3d& wi, Absorption absorption, RandomStream& rng,
            const Emit& emit) {
  Walker<1> ray({&leaf.excited}, 0, wi, absorption, rng);
  if (!ray.enter(ray.next_crossings(), sample_disk(rng), kNoConnection)) return;
  for (StopPoll poll; ray.inside(); poll()) {
    const double before = ray.weights()[0], attenuation = ray.attenuation();
    const bool is_weighted = absorption == Absorption::weighted;
    if (is_weighted && attenuation > 0) emit(ray, -before * std::expm1(-attenuation));
    if (ray.step(kNoConnection)) continue;
    if (!is_weighted && !ray.is_trapped()) emit(ray, before);
    return;
  }
}

/// Follows light that is emitted at `depth` of its medium, as a share from the upper boundary. Afterwards the ray is
/// outside, unless the light has been reabsorbed.
template <class Connect>
void emit_from(Walker<1>& ray, double depth, const Connect& connect) {
  if (!ray.step(connect, ray.up() ? depth : 1 - depth)) return;
  for (StopPoll poll; ray.inside() && ray.step(connect);) poll();
}

}  // namespace

FluorescenceEnd walk_fluorescence(const FluorescingTissue& leaf, const Vec3d& wi, Absorption absorption,
                                  RandomStream& rng) {
  FluorescenceEnd end;
  excite(leaf, wi, absorption, rng, [&](const Walker<1>& absorbed, double weight) {
    const double depth = absorption_depth(absorbed, rng);
    Walker<1> ray({&leaf.emitting}, 0, isotropic(rng), absorbed.medium(), absorbed.above(), absorption, rng);
    emit_from(ray, depth, kNoConnection);
    const double left = ray.inside() ? 0 : weight * ray.weights()[0];
    end.emitted += weight;
    end.reabsorbed += weight - left;
    end.left[ray.up() == (wi.z > 0) ? 0 : 1] += left;
  });
  return end;
}

double estimate_fluorescence_f(const FluorescingTissue& leaf, const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                               RandomStream& rng) {
  const double n = leaf.emitting.n_cuticle();
  const InnerDirection inner(wo, n);
  const bool exits_up = wo.z > 0;
  const size_t exit_medium = exits_up ? 1 : 5;
  double sum = 0;
  excite(leaf, wi, absorption, rng, [&](const Walker<1>& absorbed, double weight) {
    const double depth = absorption_depth(absorbed, rng);
    Walker<1> ray({&leaf.emitting}, 0, isotropic(rng), absorbed.medium(), absorbed.above(), absorption, rng);
    // The last direction inside the leaf is drawn from a lobe: the walk is connected to wo there.
    emit_from(ray, depth, [&](const Lobe& lobe) {
      if (ray.medium() == exit_medium && ray.up() == exits_up)
        sum += weight * ray.weights()[0] * Walker<1>::lobe_density(lobe, ray.axis(0), inner.w);
    });
  });
  return sum * inner.factor(n);
}

}  // namespace frond::leaf
