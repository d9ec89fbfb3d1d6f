#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/spectrum.h"

namespace frond {

/// Reflectance of bare soil, dry or with films of water on it by BSM (Verhoef, van der Tol and Middleton 2018, Remote
/// Sensing of Environment 204:942-963). Lambertian.
class Soil {
 public:
  /// Coefficients of three dry vectors and of one of soil moisture: the General Spectral Vectors of Jiang and Fang 2019
  /// (Int. J. Appl. Earth Obs. Geoinf. 83:101932). They sum to a reflectance, which is clamped to [0, 1].
  using Coefficients = std::array<double, 4>;

  /// The vectors begin at 400 nm; below, the first value is used.
  static constexpr Interval kRange_nm{300, 2500};
  /// Moistures, percent of the volume, between which the films change: with less there is none, and with more there
  /// would be more than BSM's sum has.
  static constexpr Interval kMoisture{5, 55};

  explicit Soil(const Coefficients& coefficients);
  /// Soil with this reflectance when dry, which is linear between values every 10 nm.
  explicit Soil(const Spectrum& dry);

  /// Returns the reflectance of the soil with this moisture (percent of the volume).
  float reflectance(float lambda_nm, float moisture) const;
  /// Upper bound of the reflectance, at any moisture.
  float max_reflectance() const { return max_; }

 private:
  /// Optical constants of BSM at one wavelength.
  struct Optics {
    float dry;        ///< reflectance of the dry soil in air
    float submerged;  ///< reflectance of the dry soil in water
    float surface;    ///< reflectance of a water surface for light from the air
    float enclosed;   ///< reflectance of a water surface for diffuse light from below
    float film;       ///< transmittance of a film of water, down and up

    /// Reflectance of the soil below films whose transmittance, down and up, is `attenuation`.
    float below_films(float attenuation) const {
      const float soil = attenuation * submerged;
      return surface + (1 - surface) * (1 - enclosed) * soil / (1 - enclosed * soil);
    }
  };

  /// `dry` has a reflectance at each wavelength of soil.csv.
  void prepare(const std::vector<double>& dry);

  std::vector<Optics> optics_;  ///< every kStep_nm from kFirst_nm
  float max_ = 0;
};

/// Soil of Jiang and Fang 2019, table 3.
struct NamedSoil {
  std::string_view name;
  Soil::Coefficients coefficients;
};

inline constexpr NamedSoil kSoils[] = {
    {"dry_clay", {0.459, 0.011, -0.009, 0.038}},
    {"median_humid_clay", {0.528, -0.011, 0.014, -0.129}},
    {"wet_clay", {0.245, -0.039, 0.003, -0.145}},
    {"dry_sand", {0.539, -0.009, -0.068, 0.079}},
    {"median_humid_sand", {0.512, -0.044, -0.044, -0.103}},
    {"wet_sand", {0.649, -0.065, 0.002, -0.587}},
    {"dry_peat", {0.384, -0.22, 0.044, -0.066}},
    {"median_humid_peat", {0.581, -0.268, 0.061, -0.303}},
    {"wet_peat", {0.423, -0.163, 0.045, -0.461}},
};

}  // namespace frond
