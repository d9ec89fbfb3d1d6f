#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/integrator.h"
#include "integrators/light_selector.h"
#include "integrators/local_bsdf.h"

namespace frond {

/// Parts that the path loops of `path`, `volpath` and FluxMeter (radiometry/flux.h) share.

/// Values of the parameter "lightsampler", in the order of LightSelector::Strategy.
inline constexpr std::string_view kLightSamplers[] = {"uniform", "power", "bvh"};

inline LightSelector::Strategy light_strategy(const Params& p) {
  return LightSelector::Strategy(std::ranges::find(kLightSamplers, p.string("lightsampler")) - kLightSamplers);
}

/// Parameter of `path` and `volpath`; as in pbrt-v4.
inline constexpr Param kRegularize{.name = "regularize",
                                   .kind = ParamKind::boolean,
                                   .default_value = false,
                                   .doc =
                                       "After a scattering that is not specular, widen the narrow lobes of metals, "
                                       "dielectrics and coats: alpha below 0.3 becomes 2 alpha, between 0.1 and 0.3. "
                                       "Caustics are blurred, with less noise; biased."};

/// Parameter of `path` and `volpath`.
inline constexpr Param kHideBackground{.name = "hidebackground",
                                       .kind = ParamKind::boolean,
                                       .default_value = false,
                                       .doc =
                                           "Camera rays that meet no surface bring no light from the environment: a "
                                           "black background, for compositing with channel alpha."};

/// Largest number of surfaces without a BSDF that a path or a shadow ray passes: rounding could make a ray hit the same
/// surface without end.
inline constexpr int kMostPassed = 1000;

/// Russian roulette of `volpath` and of fluorescence starts after these scatterings; that of `path` then depends on the
/// throughput alone.
inline constexpr int kSafeScatterings = 5;

/// A shadow ray ends short of the light's own surface, at this share of the distance.
inline constexpr float kBeforeLight = 1 - 0x1p-13f;

/// Russian roulette: a path whose `value` is below `full` survives with the probability value / full, which divides its
/// throughput. Returns false if the path ends.
inline bool survives_roulette(float value, float full, RandomStream& random, SampledSpectrum& throughput) {
  if (value >= full) return true;
  if (random.uniform() * full >= value) return false;
  throughput *= full / value;
  return true;
}

/// Returns `act()`, which calls plug-ins at a surface. An exception of theirs becomes a SurfaceError with the material
/// of the surface. Calls may be nested: the innermost names the surface.
template <class Act>
auto name_material_in_errors(const SurfacePoint& point, const Act& act) {
  try {
    return act();
  } catch (const SurfaceError&) {
    throw;
  } catch (...) {
    throw SurfaceError(point.material_id, plugin_defect());
  }
}

/// Whether a surface scatters light other than in delta lobes alone.
inline bool is_rough(const Bsdf& bsdf) { return any(bsdf.flags() & (Lobes::diffuse | Lobes::glossy)); }

/// Writes the members one by one: a copy of the whole would wait for these writes.
inline void set_first_hit(const SurfacePoint& point, FirstHit& first) {
  first.is_hit = true;
  first.material = point.material_id;
  first.instance = point.instance_id;
  first.p = point.hit.p;
  first.n = point.hit.shading.z;
  first.ng = point.hit.ng;
  first.uv = point.hit.at.uv;
  first.albedo = {};
}

/// FirstHit::albedo of a hit that scatters, from `samples` samples. Without a hero, so that they spread over the lanes.
inline SampledSpectrum first_albedo(const SurfacePoint& point, SampledWavelengths lambda, const Vec3& wo, int samples,
                                    uint64_t key, Arena& arena) {
  lambda.hero = -1;
  LocalBsdf bsdf;
  bsdf.set(*point.material->evaluate(point.hit, lambda, arena), point.hit, wo);
  return bsdf.albedo(samples, key);
}

inline bool is_unit(const Vec3& direction) {
  constexpr float kRounding = 1e-2f;
  return std::abs(dot(direction, direction) - 1) < kRounding;
}

/// Whether a BSDF may return this sample.
inline bool is_valid_sample(const LocalBsdf::Sample& sample) {
  return sample.weight.is_physical() && sample.pdf > 0 && is_unit(sample.wi);
}

/// The same for scattered light.
inline bool is_valid_sample(const Scattered& light) {
  return light.weight.is_physical() && (light.weight.is_black() || is_unit(light.direction));
}

/// Whether a light may return this sample.
inline bool is_valid_sample(const LightSample& sample) {
  return sample.radiance.is_physical() && sample.pdf > 0 && sample.pdf < INFINITY && sample.distance > 0 &&
         is_unit(sample.wi);
}

/// Scatters light that meets a surface along `d`. Returns false if the surface has no BSDF there. Throws SurfaceError.
inline bool scatter_light(const SurfacePoint& point, const SampledWavelengths& lambda, const Vec3& d,
                          RandomStream& random, Arena& arena, Scattered& scattered) {
  return name_material_in_errors(point, [&] {
    const Bsdf* bsdf = point.material->evaluate(point.hit, lambda, arena);
    if (!bsdf) return false;
    LocalBsdf local;
    local.set(*bsdf, point.hit, -d);
    local.scatter_light(random, scattered);
    if (!is_valid_sample(scattered))
      throw SurfaceError(point.material_id, "it scatters weights that are negative, infinite or not a number");
    return true;
  });
}

}  // namespace frond
