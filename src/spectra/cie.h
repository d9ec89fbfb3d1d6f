#pragma once

#include "core/spectrum.h"
#include "spectra/matrix3.h"

namespace frond {

/// Where the colour matching functions and D65 are tabulated (nm). Beyond it the eye sees nothing; light still exists.
inline constexpr Interval kCieRange_nm{360, 830};

/// CIE 1931 2 degree colour matching functions, linear between their points; 0 outside kCieRange_nm.
Triple cie_xyz(double lambda_nm);

/// Integral of (xbar, ybar, zbar) times `s` over kCieRange_nm, without any constant factor.
Triple to_xyz(const Spectrum& s);

/// Integral of ybar times `s`. A light whose spectrum is divided by this has luminance Y = 1.
double photometric(const Spectrum& s);

/// `s` scaled so that its luminance Y is 1; black stays black.
SpectrumPtr unit_luminance(SpectrumPtr s);

/// CIE standard illuminant D65 as published: 100 at 560 nm.
SpectrumPtr d65();

/// D65 with luminance Y = 1: the reference white of emission.
SpectrumPtr unit_d65();

}  // namespace frond
