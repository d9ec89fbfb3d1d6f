#pragma once

#include "core/arena.h"
#include "core/world.h"
#include "integrators/spectral_path.h"

namespace frond {

/// Medium of a ray that leaves a surface in the direction `w`; `current` is that of the ray that met the surface.
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
  /// Transmittance, and the densities of the passage by scattering and by light sampling (SpectralPath).
  const SpectralPath& path() const { return path_; }

 private:
  bool pass_medium(const Ray& ray, RandomStream& rng);

  const World& world_;
  const SampledWavelengths& lambda_;
  SpectralPath path_;
  Origin origin_{};
  const Medium* medium_ = nullptr;
  float time_;
  StopPoll& poll_;
};

}  // namespace frond
