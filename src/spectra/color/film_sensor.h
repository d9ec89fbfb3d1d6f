#pragma once

#include <string_view>
#include <vector>

#include "core/spectrum.h"
#include "spectra/matrix3.h"

namespace frond {

/// Names of the film's sensors, as in pbrt-v4: the CIE 1931 observer and cameras.
inline constexpr std::string_view kFilmSensors[] = {
    "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
    "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
    "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
    "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};

/// Spectral response of a film: three curves whose integrals with radiance are XYZ relative to D65. The curves of a
/// camera are the linear combinations of its three channels that best reproduce the observer's XYZ on rawtoaces'
/// training patches (least squares). pbrt-v4 uses the 24 patches of a ColorChecker, whose measured reflectances it has
/// by permission: colours differ by a mean CIE76 difference of 0.5. Thread-safe.
class FilmSensor {
 public:
  /// `name` is one of kFilmSensors. `white_kelvin` is the colour temperature of the daylight that becomes white; 0
  /// means 6500 K for cameras and no white balance for cie1931.
  FilmSensor(std::string_view name, double white_kelvin);
  /// Returns the three curves at a wavelength, linear between whole nanometres; 0 outside kCieRange_nm.
  Triple at(double lambda_nm) const;

 private:
  std::vector<Triple> curves_;  ///< at 360 nm, 361 nm, ...
};

/// Files of src/spectra/data, which CMake embeds in the library; their first lines state the sources.
extern const std::string_view sensors_csv, training_patches_csv;

}  // namespace frond
