#pragma once

#include <vector>

#include "core/spectrum.h"

namespace frond {

/// Clear atmosphere and position of the sun: inputs of SPECTRL2. The defaults are a clear day in summer.
struct Atmosphere {
  double sun_zenith_deg = 30;   ///< [0, 90]
  double aerosol = 0.1;         ///< aerosol optical depth at 500 nm, vertical
  double angstrom = 1.14;       ///< Angstrom exponent of the aerosol optical depth
  double water_cm = 1.42;       ///< precipitable water
  double ozone_atm_cm = 0.31;   ///< 1 atm-cm is 1000 Dobson units
  double pressure_Pa = 101325;  ///< at the ground
  double albedo = 0;            ///< of the ground; adds light that is reflected between ground and sky to the diffuse
  int day = 172;                ///< of the year, 1 to 366: decides the distance of the sun
};

/// Spectral irradiances, W m^-2 nm^-1, at the wavelengths `nm` from 300 to 2500 nm.
struct ClearSkyIrradiance {
  std::vector<double> nm;
  std::vector<double> extraterrestrial;  ///< on a plane that faces the sun, above the atmosphere
  std::vector<double> direct_normal;     ///< of the sun, on a plane that faces it
  std::vector<double> diffuse;           ///< of the sky, on a horizontal plane
};

/// Returns the irradiances by SPECTRL2 (Bird and Riordan 1984, 1986), in the form of NREL's program spectrl2_2.c, which
/// pvlib follows too. Not negative.
ClearSkyIrradiance spectrl2(const Atmosphere& a);

/// Returns the square of the mean distance of the sun over its distance on this day of the year (Spencer 1971).
double sun_distance_factor(int day);

/// Returns the relative air mass at a zenith angle in [0, 90] degrees (Kasten and Young 1989).
double relative_air_mass(double sun_zenith_deg);

/// Returns the integral of `values` over `nm` by the trapezoid rule.
double integral(const std::vector<double>& nm, const std::vector<double>& values);

}  // namespace frond
