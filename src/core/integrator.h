#pragma once

#include <array>
#include <memory>

#include "core/arena.h"
#include "core/sampler.h"
#include "core/world.h"

namespace frond {

/// What a camera ray met first.
struct FirstHit {
  bool is_hit = false;  ///< false: nothing, no leaf, and the rest means nothing
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

/// Samples of one pixel that are traced together. Sample indices of a bundle begin at a multiple of `kMost`.
struct PathBundle {
  static constexpr int kMost = 16;
  static_assert(kMost % RayPacket::kWidth == 0);

  const Sampler& sampler;
  uint32_t dimension = 0;  ///< of the sampler, that no number has been taken from yet
  PixelSamples samples{};  ///< kMost of them
  uint32_t lanes = 0;      ///< those that have a camera ray, by bit
  uint32_t wanted = 0;     ///< those whose results are asked for: some of `lanes`
  std::array<Ray, kMost> rays{};
  std::array<SampledWavelengths, kMost> lambda{};
  std::array<uint64_t, kMost> keys{};  ///< of the paths' random streams: sample_key
  std::array<PathResult, kMost> results{};
  uint64_t traced = 0;  ///< rays that were traced for the results, shadow rays included
};

/// What one thread traces paths with.
class Tracer {
 public:
  virtual ~Tracer() = default;
  /// Sets the results that are wanted: unbiased estimates of the radiance that arrives along the rays. Changes nothing
  /// else of the bundle but `traced`.
  virtual void trace(PathBundle& bundle) = 0;
};

/// Radiance along camera rays.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Called once, before the first path.
  virtual void prepare(const World&) {}
  /// For one thread; the world and the integrator outlive it. Thread-safe.
  virtual std::unique_ptr<Tracer> tracer(const World& world) const = 0;
};

/// What a path is traced with by itself.
struct PathContext {
  SampleNumbers sampler;
  uint64_t key;  ///< of this path's random streams: sample_key
  Arena& arena;
  uint64_t rays = 0;  ///< traced so far, shadow rays included
};

/// An integrator that knows one path at a time.
class OnePathIntegrator : public Integrator {
 public:
  /// Unbiased estimate of the radiance that arrives along `ray`. Thread-safe.
  virtual PathResult trace(const World& world, const Ray& ray, SampledWavelengths lambda,
                           PathContext& context) const = 0;
  std::unique_ptr<Tracer> tracer(const World& world) const final;
};

struct IntegratorInfo : PluginInfo {
  std::unique_ptr<Integrator> (*make)(const Params&);
};

}  // namespace frond
