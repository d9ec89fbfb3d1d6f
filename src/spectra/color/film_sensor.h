#pragma once

#include <string_view>
#include <vector>

#include "core/spectrum.h"
#include "spectra/matrix3.h"

namespace frond {

/// What films can be made of, by pbrt-v4's names.
inline constexpr std::string_view kFilmSensors[] = {
    "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
    "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
    "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
    "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};

/// A film's responses, as curves whose integrals over radiance are XYZ relative to D65. A camera's are those
/// combinations of its own that come nearest to the observer's on the patches of a ColorChecker (least squares), as in
/// pbrt-v4.
class FilmSensor {
 public:
  /// `name` of kFilmSensors. `white_kelvin`: the daylight that is to be white; 0: of cameras 6500 K, of cie1931 none.
  FilmSensor(std::string_view name, double white_kelvin);
  /// Linear between whole nanometres; 0 beyond the visible.
  Triple at(double lambda_nm) const;

 private:
  std::vector<Triple> curves_;  ///< at 360 nm, 361 nm, ...
};

/// The files of src/spectra/data, put into the library by CMake.
extern const std::string_view sensors_csv, color_checker_csv;

}  // namespace frond
