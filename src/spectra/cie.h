#pragma once

#include "core/spectrum.h"
#include "spectra/matrix3.h"

namespace frond {

/// Wavelengths (nm) of the tables of the colour matching functions and D65. Beyond them the colour matching functions
/// are 0; a light may still emit there.
inline constexpr Interval kCieRange_nm{360, 830};

/// Returns the CIE 1931 2 degree colour matching functions (xbar, ybar, zbar) at a wavelength, interpolated linearly
/// between table entries 5 nm apart; 0 outside kCieRange_nm.
Triple cie_xyz(double lambda_nm);

/// Returns the integral of (xbar, ybar, zbar) times `s` over kCieRange_nm (nm), without any constant factor.
Triple to_xyz(const Spectrum& s);

/// Returns the integral of ybar times `s` over kCieRange_nm. A light divided by this value has luminance Y = 1.
double photometric(const Spectrum& s);

/// Returns `s` scaled to luminance Y = 1. A spectrum of luminance 0 is returned unchanged.
SpectrumPtr unit_luminance(SpectrumPtr s);

/// CIE standard illuminant D65 as published: 360 to 830 nm, 100 at 560 nm (CIE 15:2004).
SpectrumPtr d65();

/// D65 scaled to luminance Y = 1: the reference white of emission and of the film.
SpectrumPtr unit_d65();

}  // namespace frond
