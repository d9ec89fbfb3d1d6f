#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "core/units/interval.h"
#include "core/wavelengths.h"

namespace frond {

/// Wavelengths (nm) of the light that excites fluorescence, and of the light that is emitted.
inline constexpr Interval kExcitation_nm{400, 750}, kEmission_nm{640, 850};

/// Numbers of photons per photon that meets a surface at the excitation wavelength. Those of emission are densities,
/// per nm of the emission wavelength.
struct FluorescencePhotons {
  double absorbed = 0;       ///< by the constituents that emit
  double emitted = 0;        ///< 1/nm, inside
  double reabsorbed = 0;     ///< 1/nm, of the emitted ones; these do not excite again
  double lit_side = 0;       ///< 1/nm, leave on the side of the light, in all directions (Mb)
  double opposite_side = 0;  ///< 1/nm, leave on the other side (Mf)
};

/// Fluorescence of a material, the same at every point of its surface. Quantities count photons; energies are obtained
/// with the factor excitation / emission wavelength. Directions are unit vectors in the frame of the surface, z its
/// normal on the front. Not symmetric: the exchange of both directions also exchanges both wavelengths. Thread-safe.
class Fluorescence {
 public:
  virtual ~Fluorescence() = default;

  /// Name and source of the distribution of emitted wavelengths.
  virtual std::string emission_shape() const = 0;
  /// Whether nothing is emitted.
  virtual bool is_black() const = 0;
  /// Whether `f` and `photons` are random estimates.
  virtual bool is_noisy() const = 0;

  /// Returns the photon radiance that leaves along `wo` per nm of emission, over the photon irradiance by light from
  /// `wi`: 1/(sr nm). Its integral times |cos theta_o| over one side is lit_side or opposite_side.
  virtual double f(const Vec3& wo, const Vec3& wi, double emission_nm, double excitation_nm,
                   RandomStream& rng) const = 0;
  /// Returns the numbers of photons for light from `wi`.
  virtual FluorescencePhotons photons(const Vec3& wi, double emission_nm, double excitation_nm,
                                      RandomStream& rng) const = 0;
  /// Returns an estimate of the share of diffuse light that the emitting constituents absorb. Times the spectrum of the
  /// light it is the density from which a path draws its excitation wavelength; above 0 wherever `f` is.
  virtual double excitation(double excitation_nm) const = 0;
};

struct Preparation;

/// Base of the materials that can fluoresce, beside Material: all others are unchanged. A renderer asks a material for
/// it by dynamic_cast, once before the first path.
class FluorescentMaterial {
 public:
  virtual ~FluorescentMaterial() = default;
  /// Returns the material's fluorescence, not null. Independent of Material::prepare, so that nothing is computed
  /// unless fluorescence is asked for. Throws InputError.
  virtual std::shared_ptr<const Fluorescence> fluorescence(const Preparation& preparation) const = 0;
};

/// Whether a band is of fluorescence: of the light that surfaces emit at its wavelength, without what they reflect.
/// Such a band has a name and no response. A path carries bands of one kind alone.
inline bool is_of_fluorescence(const Band& band) { return band.response.empty() && !band.name.empty(); }

/// Returns the index of the first band of fluorescence: all further ones are of this kind. The number of bands if there
/// is none.
inline size_t first_fluorescence_band(const WavelengthStrategy& wavelengths) {
  const auto bands = wavelengths.bands();
  return static_cast<size_t>(std::ranges::find_if(bands, is_of_fluorescence) - bands.begin());
}

/// Base of the wavelength strategies of colours that can show fluorescence, beside WavelengthStrategy.
class FluorescenceColors {
 public:
  virtual ~FluorescenceColors() = default;
  /// Whether paths add the fluorescence at their wavelengths to what surfaces reflect.
  virtual bool adds_fluorescence() const = 0;
};

/// Whether paths carry fluorescence: in bands of its own, or added to colours.
inline bool has_fluorescence(const WavelengthStrategy& wavelengths) {
  const auto* colors = dynamic_cast<const FluorescenceColors*>(&wavelengths);
  return (colors && colors->adds_fluorescence()) || std::ranges::any_of(wavelengths.bands(), is_of_fluorescence);
}

/// Base of the integrators that compute fluorescence, beside Integrator; asked for by dynamic_cast.
class FluorescenceIntegrator {
 public:
  virtual ~FluorescenceIntegrator() = default;
  /// Called once, before Integrator::prepare, if paths carry fluorescence (has_fluorescence). `by_material`: by
  /// SurfacePoint::material_id; nullptr: the material emits nothing.
  virtual void set_fluorescence(std::vector<std::shared_ptr<const Fluorescence>> by_material) = 0;
};

}  // namespace frond
