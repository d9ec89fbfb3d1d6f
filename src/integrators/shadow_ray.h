#pragma once

#include "core/arena.h"
#include "core/world.h"
#include "media/tracking.h"

namespace frond {

/// A path with the densities of its vertices, for single-sample multiple importance sampling over wavelengths (Miller
/// et al. 2019, "A null-scattering path integral formulation of light transport"; pbrt 4th ed., 14.2.2). Distances in
/// media are sampled for one lane, the hero, which is drawn uniformly for each path, so that the density of the whole
/// is the mean over lanes. All members are relative to the density of the hero's sampling.
struct SpectralPath {
  SampledSpectrum beta;  ///< throughput
  SampledSpectrum r_u;   ///< density of the same path if lane i were the hero
  /// Like r_u, but without the density of the last direction, for which light sampling has a density of its own.
  SampledSpectrum r_l;
  int hero = 0;

  void multiply(const SampledSpectrum& b, const SampledSpectrum& u, const SampledSpectrum& l) {
    beta *= b, r_u *= u, r_l *= l;
  }
};

inline SampledSpectrum null_coefficient(const SampledSpectrum& majorant, const MediumPoint& at) {
  return SampledSpectrum(larger(majorant.v - at.sigma_a.v - at.sigma_s.v, Float4{}));
}

/// Medium of a ray that leaves a surface in the direction `w`; `current`: medium of the ray that hit the surface.
inline const Medium* medium_beyond(const World& world, const SurfacePoint& point, const Vec3& w,
                                   const Medium* current) {
  if (point.medium_interface == 0) return current;
  const MediumInterface& sides = world.medium_interfaces()[point.medium_interface - 1];
  return dot(w, point.hit.ng) > 0 ? sides.outside : sides.inside;
}

/// Ray from a scattering to a light sample, through media and invisible surfaces.
class ShadowRay {
 public:
  /// Point of the scattering, and the offset of rays that leave it.
  struct Origin {
    Vec3 p, offset;
  };

  /// `time`: of the path's rays. `poll` counts rays and null collisions.
  ShadowRay(const World& world, const SampledWavelengths& lambda, int hero, float time, StopPoll& poll)
      : world_(world),
        lambda_(lambda),
        path_{SampledSpectrum(1), SampledSpectrum(1), SampledSpectrum(1), hero},
        time_(time),
        poll_(poll) {}

  void begin(const Origin& origin, const Medium* medium) {
    origin_ = origin;
    medium_ = medium;
  }
  /// Returns false if the light is occluded. Adds the number of rays to `rays`.
  bool trace(const LightSample& sample, uint64_t key, Arena& arena, uint64_t& rays);
  /// Transmittance, with the densities of this path by scattering and by light sampling.
  const SpectralPath& path() const { return path_; }

 private:
  /// Multiplies `path` by the transmittance of the ray's medium. Returns false if nothing is transmitted.
  bool attenuate(const Ray& ray, RandomStream& rng);

  const World& world_;
  const SampledWavelengths& lambda_;
  SpectralPath path_;
  Origin origin_{};
  const Medium* medium_ = nullptr;
  float time_;
  StopPoll& poll_;
};

}  // namespace frond
