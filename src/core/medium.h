#pragma once

#include <memory>

#include "core/majorants.h"
#include "core/phase.h"
#include "core/plugin.h"
#include "core/wavelengths.h"

namespace frond {

/// Properties of a medium at a point.
struct MediumPoint {
  SampledSpectrum sigma_a, sigma_s;  ///< absorption and scattering coefficients, 1/unit
  SampledSpectrum emission{};        ///< radiance emitted for each unit of length: sigma_a Le in pbrt-v4's terms
  Phase phase{};
};

/// Participating medium, in world space. Thread-safe.
class Medium {
 public:
  virtual ~Medium() = default;
  virtual MediumPoint properties(const Vec3& p, const SampledWavelengths& lambda) const = 0;
  /// Majorants along a ray of unit direction, from its origin to `ray.t_max`, in order. Where there is no piece, the
  /// medium is empty. sigma_a + sigma_s of any point of a piece must not exceed its majorant.
  virtual MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const = 0;
  /// True if the medium is the same everywhere; then the majorants are its extinction coefficient.
  virtual bool is_homogeneous() const { return false; }
  virtual bool is_emissive() const { return false; }
  /// Called once, before the first path. Throws InputError if data of the medium do not cover the wavelengths
  /// (check_range); the reader of the scene checks parameters of type spectrum.
  virtual void check(const WavelengthStrategy&) const {}
};

/// Plug-in record of a medium.
struct MediumInfo : PluginInfo {
  /// Returns a medium, not null. Throws InputError.
  std::unique_ptr<Medium> (*make)(const Params&, const Transform& world_from_medium);
};

/// `make` of a medium class T with a constructor T(const Params&, const Transform&).
template <class T>
std::unique_ptr<Medium> make_medium(const Params& p, const Transform& world_from_medium) {
  return std::make_unique<T>(p, world_from_medium);
}

}  // namespace frond
