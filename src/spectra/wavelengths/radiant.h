#pragma once

#include "core/spectrum.h"
#include "core/units/interval.h"

namespace frond {

/// Photosynthetically active radiation, nm.
inline constexpr Interval kPar_nm{400, 700};

/// Energy of photons: J of light at a wavelength in nm are J nm / kPhotonEnergy umol of photons. Planck constant times
/// speed of light times Avogadro constant, J nm / umol (exact since 2019).
inline constexpr double kPhotonEnergy = 6.62607015e-34 * 299792458 * 6.02214076e23 * 1e9 * 1e-6;

/// Returns the integral over all wavelengths at which the spectrum is known, in its unit times nm.
double radiant_integral(const Spectrum& spectrum);
/// Returns the photons from 400 to 700 nm, umol/s, of a spectrum in W/nm.
double par_photons(const Spectrum& spectrum);

}  // namespace frond
