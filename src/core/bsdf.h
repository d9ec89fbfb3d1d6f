#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/arena.h"
#include "core/math/random.h"
#include "core/math/vec.h"
#include "core/spectrum.h"

namespace frond {

/// Flags of a BSDF's lobes, and of the lobe that a sample came from.
enum class Lobes : uint8_t {
  none = 0,
  reflection = 1,
  transmission = 2,
  diffuse = 4,
  glossy = 8,
  specular = 16,     ///< delta lobes
  stochastic = 32,   ///< f and sample are unbiased estimates that use their random stream
  surface = 64,      ///< reflection at the surface, without entering the body (Rs of a leaf)
  from_light = 128,  ///< f is not reciprocal, and the incident direction of its model is wi, not wo
};
constexpr Lobes operator|(Lobes a, Lobes b) { return Lobes(uint8_t(a) | uint8_t(b)); }
constexpr Lobes operator&(Lobes a, Lobes b) { return Lobes(uint8_t(a) & uint8_t(b)); }
constexpr bool any(Lobes a) { return a != Lobes::none; }

/// Direction sampled from a BSDF, as pbrt's BSDFSample.
struct BsdfSample {
  SampledSpectrum f;  ///< 1/sr, without cosine; the throughput is multiplied by f |cos theta_i| / pdf
  Vec3 wi;            ///< local frame, unit
  float pdf = 0;      ///< 1/sr, positive
  Lobes flags = Lobes::none;
  /// True if f / pdf is the correct weight but `pdf` is not the density of wi (pbrt's pdfIsProportional): multiple
  /// importance sampling must then call Bsdf::pdf.
  bool pdf_is_approximate = false;
  /// For refracted light: index of refraction on the side of wi over that on the side of wo, of one lane if lanes
  /// differ. Russian roulette multiplies the throughput by eta^2, which removes the change of radiance by refraction.
  float eta = 1;
};

/// A ray of light after one scattering at a surface.
struct Scattered {
  Vec3 direction;            ///< direction in which it leaves, unit; undefined if it was absorbed
  Lobes lobe = Lobes::none;  ///< flags of the lobe that scattered it
  SampledSpectrum weight;    ///< share of the power that leaves, for each lane; 0 if it was absorbed
};

/// BSDF at one point of a surface. This comment defines the convention; other pages refer to it.
///
/// Directions. All are unit vectors in a local frame whose z axis is the shading normal (on a leaf the adaxial side).
/// Both point away from the surface: `wo` to the previous vertex of the path, `wi` to where light comes from.
/// Directions with cos theta = 0 scatter nothing.
///
/// Values. `f` is in 1/sr and contains no cosine; densities are per solid angle. The radiance along wo is the integral
/// of f(wo, wi) L(wi) |cos theta_i| over the sphere. Lanes that are not active hold 0.
///
/// Delta lobes. `f` and `pdf` leave them out. `sample` returns them with pdf = the probability of the lobe and
/// f = weight * pdf / |cos theta_i|.
///
/// Refraction. `f` applies to radiance: if wi lies on a side with another index of refraction, `f` contains the factor
/// (n_o / n_i)^2, lane by lane. Power is conserved, and reciprocity reads n_i^2 f(wo, wi) = n_o^2 f(wi, wo).
///
/// Random numbers. `uc` and `u` in [0, 1) are sample values for the first attempt of `sample`; further attempts draw
/// from `rng`. A stochastic BSDF returns unbiased estimates from `f` and `sample`, with random numbers from `rng`. The
/// caller passes a new stream to each call, with a key that does not depend on directions.
class Bsdf {
 public:
  /// Union of the flags of all lobes.
  virtual Lobes flags() const = 0;
  /// Value of the BSDF without its delta lobes, 1/sr.
  virtual SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const = 0;
  /// Samples wi; empty if the light is absorbed or the sample fails.
  virtual std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const = 0;
  /// Density of `sample` per solid angle, or an approximation that is positive wherever f is. Both sides of multiple
  /// importance sampling use it, so that the weights add up to 1 also if it is approximate.
  virtual float pdf(const Vec3& wo, const Vec3& wi) const = 0;

  /// Index of refraction on the side of -z over that on the side of +z, lane by lane; 1 if light is not refracted, and
  /// in lanes that are not active.
  virtual SampledSpectrum index_ratio() const { return SampledSpectrum(1); }

  /// BSDF whose narrow microfacet lobes, delta lobes too, are wider, for integrators that exchange noise for bias
  /// ("regularize"); allocated in `arena`. This BSDF itself if it has none.
  virtual const Bsdf* regularized([[maybe_unused]] Arena& arena) const { return this; }

  /// For virtual instruments: scatters light that arrives from the direction `incident` and writes one result for each
  /// of `rays`. `incident` is the incident direction of the BSDF's model: wi with the flag `from_light`, else wo. The
  /// means of the weights are reflectance and transmittance at that incidence. A BSDF with the flag `from_light` and an
  /// approximate pdf must override it.
  virtual void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const;

 protected:
  ~Bsdf() = default;  // lives in an arena and is never deleted
};

/// True if both directions lie on the same side of the surface.
inline bool same_side(const Vec3& a, const Vec3& b) { return a.z * b.z > 0; }

/// Factor that converts `f`, which applies to radiance, to transport of power: (n_i / n_o)^2, lane by lane, if wo and
/// wi lie on different sides, else 1.
inline SampledSpectrum radiance_to_power(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (wo.z * wi.z >= 0) return SampledSpectrum(1);
  const SampledSpectrum ratio = bsdf.index_ratio();
  const SampledSpectrum square = ratio * ratio;
  return wo.z > 0 ? square : SampledSpectrum(1 / square.v);
}

}  // namespace frond
