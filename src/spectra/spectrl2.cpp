#include "spectra/spectrl2.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/vec.h"
#include "spectra/csv_columns.h"
#include "spectra/data_files.h"

namespace frond {
namespace {

/// Transmittances of the atmosphere at one wavelength along one air mass.
struct Transmittances {
  double rayleigh, aerosol, water, ozone, mixed_gases;
  double aerosol_scattering, aerosol_absorption;
};

/// Optical properties of the air at one wavelength.
struct Air {
  double um;                                        ///< wavelength
  double water_per_cm, ozone_per_atm_cm, gases;     ///< absorption coefficients of the table
  double aerosol_depth, aerosol_scattering_albedo;  ///< vertical optical depth; single-scattering albedo
};

// Equation numbers refer to SERI/TR-215-2436. Where report and NREL's program differ, constants are the program's:
// 1.3366 in 2-4 (report: 1.335) and 118.3 in 2-11 (118.93).
Transmittances transmittances(const Atmosphere& a, const Air& air, double relative_mass) {
  constexpr double kStandardPressure_Pa = 101300, kOzoneHeight = 22.0 / 6370;
  const double mass = relative_mass * a.pressure_Pa / kStandardPressure_Pa, um2 = air.um * air.um;
  const double water = air.water_per_cm * a.water_cm * relative_mass, gases = air.gases * mass;
  const double cos_zenith = std::cos(a.sun_zenith_deg * kDegree);
  const double ozone_mass = (1 + kOzoneHeight) / std::sqrt(cos_zenith * cos_zenith + 2 * kOzoneHeight);  // 2-10
  const double depth = air.aerosol_depth * relative_mass, albedo = air.aerosol_scattering_albedo;
  return {.rayleigh = std::exp(-mass / (um2 * um2 * (115.6406 - 1.3366 / um2))),       // 2-4
          .aerosol = std::exp(-depth),                                                 // 2-6
          .water = std::exp(-0.2385 * water / std::pow(1 + 20.07 * water, 0.45)),      // 2-8
          .ozone = std::exp(-air.ozone_per_atm_cm * a.ozone_atm_cm * ozone_mass),      // 2-9
          .mixed_gases = std::exp(-1.41 * gases / std::pow(1 + 118.3 * gases, 0.45)),  // 2-11
          .aerosol_scattering = std::exp(-albedo * depth),                             // 3-9
          .aerosol_absorption = std::exp(-(1 - albedo) * depth)};                      // 3-10
}

/// Shares of the light scattered by aerosol that goes down, for the asymmetry of the report's rural aerosol.
struct DownwardShares {
  double direct, diffuse;  ///< of the sun's light; of light that the ground has reflected
};

DownwardShares downward_shares(double cos_zenith) {
  constexpr double kAsymmetry = 0.65;
  const double g = std::log(1 - kAsymmetry);                      // 3-14
  const double a = g * (1.459 + g * (0.1595 + g * 0.4129));       // 3-12
  const double b = g * (0.0783 + g * (-0.3824 - g * 0.5874));     // 3-13
  return {1 - 0.5 * std::exp((a + b * cos_zenith) * cos_zenith),  // 3-11
          1 - 0.5 * std::exp((a + b / 1.8) / 1.8)};               // 3-15
}

}  // namespace

double sun_distance_factor(int day) {
  const double x = 2 * std::numbers::pi * (day - 1) / 365;
  return 1.00011 + 0.034221 * std::cos(x) + 0.00128 * std::sin(x) + 0.000719 * std::cos(2 * x) +
         0.000077 * std::sin(2 * x);
}

double relative_air_mass(double sun_zenith_deg) {
  return 1 / (std::cos(sun_zenith_deg * kDegree) + 0.50572 * std::pow(96.07995 - sun_zenith_deg, -1.6364));
}

ClearSkyIrradiance spectrl2(const Atmosphere& a) {
  constexpr double kScatteringAlbedo = 0.945, kScatteringSlope = 0.095;  // rural aerosol, at 400 nm
  constexpr double kDiffuseMass = 1.8;                                   // air mass of diffuse light
  const auto table = csv_columns(spectrl2_csv);  // nm, extraterrestrial, water vapour, ozone, mixed gases
  const double cos_zenith = std::max(0.0, std::cos(a.sun_zenith_deg * kDegree));
  const double relative_mass = relative_air_mass(a.sun_zenith_deg), distance = sun_distance_factor(a.day);
  const DownwardShares down = downward_shares(cos_zenith);
  ClearSkyIrradiance result{.nm = table[0], .extraterrestrial = {}, .direct_normal = {}, .diffuse = {}};
  for (size_t i = 0; i < table[0].size(); ++i) {
    const double nm = table[0][i], slope = std::log(nm / 400);
    const Air air{
        .um = nm / 1000,
        .water_per_cm = table[2][i],
        .ozone_per_atm_cm = table[3][i],
        .gases = table[4][i],
        .aerosol_depth = a.aerosol * std::pow(nm / 500, -a.angstrom),                                   // 2-7
        .aerosol_scattering_albedo = kScatteringAlbedo * std::exp(-kScatteringSlope * slope * slope)};  // 3-16
    const Transmittances t = transmittances(a, air, relative_mass), p = transmittances(a, air, kDiffuseMass);
    const double above = table[1][i] * distance;
    const double direct = above * t.rayleigh * t.aerosol * t.water * t.ozone * t.mixed_gases;  // 2-1
    const double scattered = above * cos_zenith * t.ozone * t.mixed_gases * t.water * t.aerosol_absorption;
    const double by_air = scattered * (1 - std::pow(t.rayleigh, 0.95)) * 0.5;                                    // 3-5
    const double by_aerosol = scattered * std::pow(t.rayleigh, 1.5) * (1 - t.aerosol_scattering) * down.direct;  // 3-6
    // Reflectance of the sky; 3-8 with the transmittance of mixed gases, as in the program, in place of ozone's.
    const double sky = p.mixed_gases * p.water * p.aerosol_absorption *
                       (0.5 * (1 - p.rayleigh) + (1 - down.diffuse) * p.rayleigh * (1 - p.aerosol_scattering));
    const double from_ground =
        (direct * cos_zenith + by_air + by_aerosol) * sky * a.albedo / (1 - sky * a.albedo);  // 3-7
    const double correction = nm <= 450 ? std::pow(air.um + 0.55, 1.8) : 1;                   // 3-17
    result.extraterrestrial.push_back(above);
    result.direct_normal.push_back(direct);
    result.diffuse.push_back((by_air + by_aerosol + from_ground) * correction);  // 3-1
  }
  return result;
}

double integral(const std::vector<double>& nm, const std::vector<double>& values) {
  double sum = 0;
  for (size_t i = 1; i < nm.size(); ++i) sum += (nm[i] - nm[i - 1]) * (values[i] + values[i - 1]) / 2;
  return sum;
}

}  // namespace frond
