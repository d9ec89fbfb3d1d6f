#pragma once

#include <array>
#include <compare>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/arena.h"
#include "core/sampler.h"
#include "core/world.h"

namespace frond {

struct CameraSampling;

/// First surface that a camera ray meets.
struct FirstHit {
  bool is_hit = false;    ///< false if the ray meets no surface; then the other members have no meaning
  uint32_t material = 0;  ///< SurfacePoint::material_id
  uint64_t instance = 0;  ///< SurfacePoint::instance_id
  Vec3 p, n;              ///< position and shading normal, unit, in world space
  Vec3 ng;                ///< geometric normal, unit, in world space
  Vec2 uv;                ///< texture coordinates
  /// Unbiased estimate of the directional albedo, the sum of reflectance and transmittance, for wo = -direction of the
  /// camera ray; black unless PathBundle::albedo_samples is set.
  SampledSpectrum albedo;
};

/// Plug-in that returned an impossible value: a value or density that is negative or not finite, or a direction that is
/// not a unit vector. The radiance of the path is then not a number.
struct PlugInFault {
  enum class Kind : uint8_t { none, material, light };
  Kind kind = Kind::none;
  uint32_t index = 0;  ///< SurfacePoint::material_id, or Light::index

  friend auto operator<=>(const PlugInFault&, const PlugInFault&) = default;  // NOLINT(modernize-use-nullptr): clang 14
};

/// Exception of a plug-in during rendering, with the material of the surface at which it was thrown.
struct SurfaceError : std::runtime_error {
  SurfaceError(uint32_t id, const std::string& what) : std::runtime_error(what), material_id(id) {}
  uint32_t material_id;
};

/// Result of one path.
struct PathResult {
  SampledSpectrum radiance;
  FirstHit first;
  int scatterings = 0;     ///< number of scatterings; if the first hit scatters two rays, along the first
  bool escaped = false;    ///< that path left the scene; otherwise it was absorbed or terminated
  PlugInFault fault = {};  ///< the last one on the path

  /// Begins the result of a path. If the path hits nothing, the members of `first` other than `is_hit` have no meaning.
  void reset() {
    radiance = {};
    first.is_hit = false;
    scatterings = 0;
    escaped = false;
    fault = {};
  }
  /// Records a fault of a material or of a light. The film counts a radiance that is not a number, and takes it as
  /// black.
  void record_fault(const SurfacePoint& point) { record_fault({PlugInFault::Kind::material, point.material_id}); }
  void record_fault(const Light& light) { record_fault({PlugInFault::Kind::light, uint32_t(light.index())}); }
  void record_fault(PlugInFault by) {
    fault = by;
    radiance = SampledSpectrum(std::numeric_limits<float>::quiet_NaN());
  }
};

/// Samples of one pixel that are traced together. The first sample index of a bundle is a multiple of `kSize`.
struct PathBundle {
  static constexpr int kSize = 16;
  static_assert(kSize % RayPacket::kWidth == 0);

  const Sampler& sampler;
  uint32_t dimension = uint32_t(Dimension::light);  ///< first unused dimension of the sampler
  PixelSamples samples{};                           ///< kSize samples
  uint32_t lanes = 0;                               ///< bit i is set if sample i has a camera ray
  uint32_t wanted = 0;  ///< bit i is set if the result of sample i is needed; a subset of `lanes`
  std::array<Ray, kSize> rays{};
  std::array<SampledWavelengths, kSize> lambda{};
  std::array<uint64_t, kSize> keys{};  ///< keys of the paths' random streams (sample_key)
  std::array<PathResult, kSize> results{};
  int albedo_samples = 0;  ///< samples of the BSDF for FirstHit::albedo; 0: it is not needed
  uint64_t traced = 0;     ///< number of rays traced, including shadow rays
};

/// Traces paths in one thread.
class Tracer {
 public:
  virtual ~Tracer() = default;
  /// Sets `results` of the wanted samples to unbiased estimates of the radiance along their rays, and adds to `traced`.
  /// It changes no other member of the bundle.
  virtual void trace(PathBundle& bundle) = 0;
};

/// Integrator: estimates the radiance along camera rays.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Called once, before the first path.
  virtual void prepare(const World&) {}
  /// Called once, after `prepare`. What an integrator adapts may change its noise and speed alone; it may trace paths
  /// of the whole image (CameraSamples). Returns what it selected, as a line for the log; empty if nothing was
  /// selected.
  virtual std::string adapt(const World&, const CameraSampling&) { return {}; }
  /// Returns a tracer for one thread, not null. The world and the integrator outlive it. Thread-safe.
  virtual std::unique_ptr<Tracer> tracer(const World& world) const = 0;
};

/// State of a path in an OnePathIntegrator.
struct PathContext {
  SampleNumbers sampler;
  uint64_t key;       ///< key of the path's random streams (sample_key)
  Arena& arena;       ///< for BSDFs; the integrator resets it
  uint64_t rays = 0;  ///< number of rays traced so far, including shadow rays
};

/// Base class of integrators that trace one path at a time; the simplest way to write an integrator.
class OnePathIntegrator : public Integrator {
 public:
  /// Unbiased estimate of the radiance that arrives along `ray`. Thread-safe.
  virtual PathResult trace(const World& world, const Ray& ray, SampledWavelengths lambda,
                           PathContext& context) const = 0;
  std::unique_ptr<Tracer> tracer(const World& world) const final;
};

/// Plug-in record of an integrator.
struct IntegratorInfo : PluginInfo {
  /// Returns an integrator, not null. Throws InputError.
  std::unique_ptr<Integrator> (*make)(const Params&);
  bool ignores_media = false;  ///< paths do not interact with the scene's media
};

}  // namespace frond
