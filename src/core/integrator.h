#pragma once

#include "core/arena.h"
#include "core/sampler.h"
#include "core/world.h"

namespace frond {

/// What a worker lends to one path.
struct PathContext {
  Sampler& sampler;
  uint64_t key;  ///< of this path's random streams: sample_key
  Arena& arena;
  uint64_t rays = 0;  ///< traced so far, shadow rays included
};

/// What a camera ray met first.
struct FirstHit {
  bool is_hit = false;  ///< false: nothing, and the rest means nothing
  bool is_leaf = false;
  uint32_t material = 0;  ///< as of a SurfacePoint
  uint64_t instance = 0;  ///< as of a SurfacePoint
  Vec3 p, n;              ///< world space; the shading normal, unit
  /// The path's weight after it was scattered there: an unbiased estimate of the albedo, all that the surface gives
  /// back of light from -direction of the camera ray, on both sides.
  SampledSpectrum albedo;
};

struct PathResult {
  SampledSpectrum radiance;
  FirstHit first;
  int scatterings = 0;   ///< how often the path was scattered
  bool escaped = false;  ///< it left the scene; else it was absorbed or cut off
};

/// Radiance along camera rays.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Called once, before the first path.
  virtual void prepare(const World&) {}
  /// Unbiased estimate of the radiance that arrives along `ray`. Thread-safe.
  virtual PathResult trace(const World& world, const Ray& ray, SampledWavelengths lambda,
                           PathContext& context) const = 0;
};

struct IntegratorInfo : PluginInfo {
  std::unique_ptr<Integrator> (*make)(const Params&);
};

}  // namespace frond
