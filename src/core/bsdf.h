#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/random.h"
#include "core/spectrum.h"
#include "core/vec.h"

namespace frond {

/// What a BSDF's lobes do, and which lobe a sample came from.
enum class Lobes : uint8_t {
  none = 0,
  reflection = 1,
  transmission = 2,
  diffuse = 4,
  glossy = 8,
  specular = 16,     ///< delta lobes
  stochastic = 32,   ///< f and sample are unbiased estimates that use their random stream
  surface = 64,      ///< light that never entered the body (Rs of a leaf)
  from_light = 128,  ///< f is not reciprocal, and the direction that its model calls incident is wi, not wo
};
constexpr Lobes operator|(Lobes a, Lobes b) { return Lobes(uint8_t(a) | uint8_t(b)); }
constexpr Lobes operator&(Lobes a, Lobes b) { return Lobes(uint8_t(a) & uint8_t(b)); }
constexpr bool any(Lobes a) { return a != Lobes::none; }

struct BsdfSample {
  SampledSpectrum f;  ///< 1/sr, without cosine; the path's weight is f |cos theta_i| / pdf
  Vec3 wi;            ///< local frame, unit
  float pdf = 0;      ///< 1/sr, positive
  Lobes flags = Lobes::none;
  /// True where f / pdf is the right weight but `pdf` is not the density of wi: MIS must ask `pdf()` instead.
  bool pdf_is_approximate = false;
  /// Of light that was refracted: the index of refraction on the side of wi over that on the side of wo. Its radiance
  /// has changed by the square of that, which says nothing of how much the path matters. Where lanes differ, of one.
  float eta = 1;
};

/// What became of a ray of light at a surface.
struct Scattered {
  Vec3 direction;            ///< the way it leaves, unit; undefined where all of it was absorbed
  Lobes lobe = Lobes::none;  ///< as of a BsdfSample
  SampledSpectrum weight;    ///< share of the ray that leaves, lane by lane
};

/// Scattering at one point of a surface.
///
/// Convention, stated here and nowhere else. Directions are unit vectors in a local frame whose z is the shading normal
/// (on a leaf: the adaxial side); both point away from the surface: `wo` toward where the path came from, `wi` toward
/// where light comes from. `f` has no cosine in it and is in 1/sr; densities are per solid angle. Radiance along wo is
/// the integral of f(wo, wi) L(wi) |cos theta_i| over the sphere. A delta lobe contributes 0 to `f` and `pdf`, and
/// `sample` returns it with pdf = its probability and f = weight * pdf / |cos theta_i|. Directions with cos theta = 0
/// scatter nothing. Lanes that are not active hold 0.
///
/// `f` is of radiance, which refraction changes: into a side of index n_i it carries the factor (n_o / n_i)^2, lane by
/// lane. Power it keeps, and it is reciprocal as n_i^2 f(wo, wi) = n_o^2 f(wi, wo).
///
/// A BSDF may be stochastic: then `f` and the weight of `sample` are unbiased estimates that draw from `rng`, a stream
/// of their own for each call, never derived from directions. `uc` and `u` in [0, 1) are the sampler's low-discrepancy
/// numbers for the first try of `sample`; redraws use `rng`.
class Bsdf {
 public:
  virtual Lobes flags() const = 0;
  virtual SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const = 0;
  virtual std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const = 0;
  /// Density of `sample`, or an approximation of it that is positive wherever f is; used to weight both strategies.
  virtual float pdf(const Vec3& wo, const Vec3& wi) const = 0;

  /// Index of refraction on the side of -z over that on the side of +z, lane by lane, where light is refracted; 1 in
  /// lanes that are not active.
  virtual SampledSpectrum index_ratio() const { return SampledSpectrum(1); }

  /// For virtual instruments: sends light in from the direction `incident`, which is what the BSDF's model calls so
  /// whichever of wo and wi that is, and tells what becomes of each ray. Means of the weights are reflectance and
  /// transmittance for that incidence. A BSDF `from_light` whose pdf is approximate must have its own.
  virtual void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const;

 protected:
  ~Bsdf() = default;  // lives in an arena and is never deleted
};

inline bool same_side(const Vec3& a, const Vec3& b) { return a.z * b.z > 0; }

/// (n_i / n_o)^2, lane by lane: power over radiance of what goes from the side of wo to that of wi.
inline SampledSpectrum power_of_radiance(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (wo.z * wi.z >= 0) return SampledSpectrum(1);
  const SampledSpectrum ratio = bsdf.index_ratio();
  const SampledSpectrum square = ratio * ratio;
  return wo.z > 0 ? square : SampledSpectrum(1 / square.v);
}

}  // namespace frond
