#pragma once

#include <memory>
#include <optional>

#include "core/light.h"
#include "core/math/transform.h"
#include "core/params.h"
#include "core/spectrum.h"

namespace frond {

/// Squared distance below which a point is taken to lie on the light itself; a division by it would overflow.
inline constexpr float kLeastSquare = 1e-30f;

/// Powers of lamps.
inline constexpr Interval kAboveZeroReal{1e-30, 1e30};

inline constexpr Param kLightScale{
    .name = "scale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor."};
inline constexpr Param kLightPower{.name = "power",
                                   .kind = ParamKind::real,
                                   .unit = "lm",
                                   .doc = "Total power, to which the light is scaled; 0 or less: not given."};

/// Parameters of lamps: the light's power in units that do not depend on the eye.
inline constexpr Param kRadiantPower{
    .name = "radiantpower",
    .kind = ParamKind::real,
    .unit = "W",
    .range = kAboveZeroReal,
    .doc =
        "Power over all wavelengths of the spectrum, of each shape, to which the light is scaled: radiance is in "
        "W/(m^2 sr nm) if the scene's unit is the metre."};
inline constexpr Param kPhotonFlux{.name = "photonflux",
                                   .kind = ParamKind::real,
                                   .unit = "umol/s",
                                   .range = kAboveZeroReal,
                                   .doc = "Photons from 400 to 700 nm, of each shape, in place of radiantpower."};

/// Returns "radiantpower" or "photonflux" divided by that of `spectrum`, the factor to spectral power in W/nm; nullopt
/// if neither is given. Throws InputError if more than one of them and "power" are given, or if the spectrum has none.
std::optional<double> stated_power(const Params& p, const Spectrum& spectrum);

/// Returns "scale" times the factor to the stated power, in lm, W or umol/s. `unit_flux`: power in lm at scale 1;
/// `geometry`: ratio of spectral power and spectrum at scale 1.
float lamp_scale(const Params& p, const Spectrum& spectrum, double unit_flux, double geometry);

/// Returns the light's stated total, "power" or "illuminance". As in pbrt-v4, values <= 0 state none; they cause a
/// warning.
std::optional<double> stated_total(const Params& p, std::string_view name);

/// Returns "scale", times the factor that makes the total match the stated one, if any.
float light_scale(const Params& p, std::string_view total, double unit_total);

}  // namespace frond
