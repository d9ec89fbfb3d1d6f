#pragma once

#include "core/material.h"

namespace frond {

/// Parallel light of one wavelength on a specimen that lies flat in an instrument.
struct Beam {
  double theta_deg;  ///< from the specimen's +z to the light, in [0, 180]: above 90 the back (abaxial) side is lit
  double lambda_nm;
};

/// Unit vector from the specimen to the light, at azimuth 0. At exactly 90 degrees light meets neither side; there the
/// beam is the limit from the front: cos theta = 1e-7, where dielectrics reflect everything (Fresnel).
Vec3 toward_light(const Beam& beam);

/// A specimen and the light on it. `material` is prepared for the beam's wavelength.
struct LitMaterial {
  const Material& material;
  Beam beam;
  uint64_t seed = 0;
  /// What a renderer shows of the specimen: light comes along the BSDF's wi and is seen along its wo, even where the
  /// material's model calls wo incident.
  bool as_rendered = false;
};

/// Throws InputError unless theta is in [0, 180] degrees and the wavelength a positive number.
void check_beam(const Beam& beam);

/// Throws InputError for fewer than 2 rays: one has no standard error.
void check_rays(int64_t rays);

/// The middle of a flat specimen, its front up.
Hit flat_hit();

/// The BSDF in the middle of a flat specimen. Throws InputError where the material says that there is no surface.
const Bsdf& bsdf_of(const Material& material, const Beam& beam, Arena& arena);

/// Light from the direction `light`, as a renderer shows it: rays leave in directions that are drawn by their cosine on
/// either side and weighted by f. Not for delta lobes.
void scatter_as_rendered(const Bsdf& bsdf, const Vec3& light, RandomStream& rng, std::span<Scattered> rays);

/// Throws InputError where the lit is as rendered and the material has a delta lobe, which f does not show.
void check_as_rendered(const LitMaterial& lit);

/// One wavelength for every path: what a material is prepared for before an instrument measures it.
class OneWavelength final : public WavelengthStrategy {
 public:
  explicit OneWavelength(double lambda_nm) : nm_(static_cast<float>(lambda_nm)) {}

  SampledWavelengths sample(float) const override;
  Interval range_nm() const override { return {double(nm_), double(nm_)}; }
  std::span<const float> fixed_nm() const override { return {&nm_, 1}; }
  /// An instrument has no film: all channels are the radiance itself.
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override;
  std::string_view film_space() const override { return "XYZ"; }

 private:
  float nm_;
};

}  // namespace frond
