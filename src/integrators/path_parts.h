#pragma once

#include <algorithm>
#include <cmath>
#include <new>
#include <string_view>

#include "core/integrator.h"
#include "integrators/light_selector.h"
#include "integrators/local_bsdf.h"

namespace frond {

/// What the integrators `path` and `volpath` share.

/// Values of the parameter "lightsampler", in the order of LightSelector::Strategy.
inline constexpr std::string_view kLightSamplers[] = {"uniform", "power", "bvh"};

inline LightSelector::Strategy light_strategy(const Params& p) {
  return LightSelector::Strategy(std::ranges::find(kLightSamplers, p.string("lightsampler")) - kLightSamplers);
}

/// Parameter of both; as in pbrt-v4.
inline constexpr Param kRegularize{.name = "regularize",
                                   .kind = ParamKind::boolean,
                                   .default_value = false,
                                   .doc =
                                       "After a scattering that is not specular, widen the narrow lobes of metals, "
                                       "dielectrics and coats: alpha below 0.3 becomes 2 alpha, between 0.1 and 0.3. "
                                       "Caustics are blurred, with less noise; biased."};

/// Parameter of both.
inline constexpr Param kHideBackground{.name = "hidebackground",
                                       .kind = ParamKind::boolean,
                                       .default_value = false,
                                       .doc =
                                           "Camera rays that meet no surface bring no light from the environment: a "
                                           "black background, for compositing with channel alpha."};

/// Largest number of invisible surfaces along one path: rounding could make a ray hit the same one without end.
inline constexpr int kMostPassed = 1000;

/// Russian roulette starts after these scatterings.
inline constexpr int kSafeScatterings = 5;

/// A shadow ray ends short of the light's own surface, at this share of the distance.
inline constexpr float kBeforeLight = 1 - 0x1p-13f;

/// Calls `act`. An exception of a plug-in gets the material of `at`, the surface whose plug-ins were called; nullptr if
/// there is none. Calls may be nested: the innermost names the surface.
template <class Act>
void with_surface_of_errors(const SurfacePoint* const& at, const Act& act) {
  try {
    act();
  } catch (const InputError&) {
    throw;
  } catch (const Stopped&) {
    throw;
  } catch (const SurfaceError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    if (!at) throw;
    throw SurfaceError(at->material_id, error.what());
  } catch (...) {
    if (!at) throw;
    throw SurfaceError(at->material_id, "it threw an object that is no std::exception");
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
inline bool is_possible(const LocalBsdf::Sample& sample) {
  return sample.weight.is_physical() && sample.pdf > 0 && is_unit(sample.wi);
}

/// Whether a light may return this sample.
inline bool is_possible(const LightSample& sample) {
  return sample.radiance.is_physical() && sample.pdf > 0 && sample.pdf < INFINITY && sample.distance > 0 &&
         is_unit(sample.wi);
}

}  // namespace frond
