#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace frond {

/// One measurement of a goniometer.
struct GoniometerRow {
  double incidence_deg;  ///< of the light, from the front's normal, in [0, 180]; above 90 the back is lit
  double wavelength_nm;
  double theta_deg;              ///< of the detector, from the front's normal, in [0, 180], not 90
  double phi_deg;                ///< of the detector, from the azimuth of the light, in [0, 360)
  double f;                      ///< BRDF, or BTDF on the other side than the light, 1/sr
  double error;                  ///< standard error of `f`; 0 if the file has none
  double projected_solid_angle;  ///< of the patch that the row is the mean of, sr; 0 if the file has none
  Location where;

  bool is_front_lit() const { return incidence_deg <= 90; }
  bool is_reflected() const { return is_front_lit() == (theta_deg < 90); }
};

/// Reads a table as `frond goniophotometer` writes it, in any layout that TextTable reads. Columns: incidence_deg,
/// wavelength_nm, theta_deg, phi_deg, f_per_sr; optional f_se, projected_solid_angle_sr, kind (BRDF or BTDF, which is
/// checked) and material (one for the file); others are ignored. Throws InputError with `name`, line and column.
std::vector<GoniometerRow> parse_goniometer_rows(std::string_view text, const std::string& name);

}  // namespace frond
