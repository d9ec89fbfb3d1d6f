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

struct PathResult {
  SampledSpectrum radiance;
  bool sees_leaf = false;  ///< the first thing the path meets is a leaf
  int scatterings = 0;     ///< how often the path was scattered
  bool escaped = false;    ///< it left the scene; else it was absorbed or cut off
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
