#pragma once

#include <string>

#include "core/material.h"
#include "spectra/wavelengths/response_sampler.h"

namespace frond {

/// Band of an instrument: the response of its detector times the spectrum of its light.
struct InstrumentBand {
  std::string name;
  ResponseSampler lit_response;
};

/// Parallel light on a flat specimen in an instrument, of one wavelength or of the wavelengths of a band.
struct Beam {
  double theta_deg;  ///< from the specimen's +z to the light, in [0, 180]: above 90 the back (abaxial) side is lit
  double lambda_nm;  ///< wavelength, or mean wavelength of the band's response
  const InstrumentBand* band = nullptr;  ///< each ray has a wavelength of its own; nullptr: lambda_nm
  double emission_nm = 0;                ///< wavelength of the detector for fluorescence; 0: that of the light
};

/// Returns what texts and charts call the light: "551 nm", "440 to 740 nm" for fluorescence, or the name of the band.
std::string label_of(const Beam& beam);

/// Returns the unit vector from the specimen to the light, at azimuth 0. At exactly 90 degrees light meets neither
/// side; the beam is then the limit from the front: cos theta = 1e-7, where dielectrics reflect all light (Fresnel).
Vec3 toward_light(const Beam& beam);

/// A material under test and the beam on it. `material` is prepared for the beam's wavelength.
struct LitMaterial {
  const Material& material;
  Beam beam;
  uint64_t seed = 0;
  /// Measure the material as a renderer shows it: light comes along the BSDF's wi and is viewed along its wo, even if
  /// the material's model takes wo as incident direction.
  bool as_rendered = false;
};

/// Throws InputError unless theta is in [0, 180] degrees and the wavelength a positive number.
void check_beam(const Beam& beam);

/// Throws InputError for fewer than 2 rays: one has no standard error.
void check_rays(int64_t rays);

/// A hit in the middle of a flat specimen, its front up.
Hit flat_hit();

/// Returns the BSDF in the middle of a flat specimen, made in `arena`; for a band, at its median wavelength. Throws
/// InputError if the material has no surface there.
const Bsdf& bsdf_of(const Material& material, const Beam& beam, Arena& arena);
/// The same at the wavelength `lambda_nm`.
const Bsdf& bsdf_at(const Material& material, float lambda_nm, Arena& arena);

/// Scatters light from the direction `light` as a renderer shows it: exitant directions are drawn by their cosine on
/// either side and weighted by f. Not for delta lobes.
void scatter_as_rendered(const Bsdf& bsdf, const Vec3& light, RandomStream& rng, std::span<Scattered> rays);

/// Throws InputError if `as_rendered` is set and the material has a delta lobe, which f does not contain.
void check_as_rendered(const LitMaterial& lit);

/// Wavelength strategy with one wavelength (nm) for every path, for which materials under test are prepared.
class OneWavelength final : public WavelengthStrategy {
 public:
  explicit OneWavelength(double lambda_nm) : nm_(static_cast<float>(lambda_nm)) {}

  SampledWavelengths sample(float) const override;
  Interval range_nm() const override { return {double(nm_), double(nm_)}; }
  std::span<const float> fixed_nm() const override { return {&nm_, 1}; }
  /// An instrument has no film: all channels are the radiance.
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override;
  std::string_view film_space() const override { return "XYZ"; }

 private:
  float nm_;
};

/// Wavelength strategy whose paths have one wavelength of a band each, for which materials under test are prepared.
class OneBand final : public WavelengthStrategy {
 public:
  /// `band` must outlive this object.
  explicit OneBand(const InstrumentBand& band) : lit_response_(band.lit_response) {}

  SampledWavelengths sample(float u) const override { return OneWavelength(double(lit_response_.sample(u))).sample(0); }
  Interval range_nm() const override { return lit_response_.support_nm(); }
  std::span<const float> fixed_nm() const override { return {}; }
  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const override {
    return std::array{double(radiance[0]), double(radiance[0]), double(radiance[0])};
  }
  std::string_view film_space() const override { return "XYZ"; }

 private:
  const ResponseSampler& lit_response_;
};

}  // namespace frond
