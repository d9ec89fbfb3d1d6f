#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "exports/format.h"

namespace frond {

/// f of a material on a grid of directions: the content of all table formats.
struct BsdfTable {
  std::vector<double> wavelengths_nm;
  static constexpr std::array<std::string_view, 2> kSides{"front", "back"};  ///< side that the light is on
  std::vector<double> theta_i_deg;  ///< 0 to below 90, between that side's normal and the light
  std::vector<double> theta_o_deg;  ///< 0 to below 90, between the viewer and the normal on the viewer's side
  std::vector<double> phi_o_deg;    ///< azimuth of the viewer relative to the light's
  static constexpr std::array<std::string_view, 2> kKinds{"reflected", "transmitted"};

  /// Directional reflectance and transmittance at theta_i, 0 to 1; shape: wavelength, side, theta_i.
  std::vector<double> reflectance, transmittance;
  /// 1/sr; shape: wavelength, side, theta_i, theta_o, phi_o, kind (fastest).
  std::vector<float> f;
};

/// Evaluates f at single directions and integrates R and T over all of them, to 1e-4 of their value. Default angles are
/// every 5 degrees from the normal and every 15 around it. Throws InputError as ExportedBsdf does, and without
/// wavelengths.
BsdfTable make_table(const ExportMaterial& material, const ExportRequest& request);

/// Throws InputError for a table of more than 2^28 numbers, which is not intended.
void check_table(const ExportRequest& request);
/// Options of all table formats.
inline constexpr ExportOption kTableOptions[] = {ExportOption::angles, ExportOption::views};

/// Name and documentation of an axis or a quantity of the table.
struct Quantity {
  std::string_view name, unit, doc;
};

/// The axes in the order of f's indices; then R, T and f.
inline constexpr Quantity kWavelength{"wavelength", "nm", "wavelength in vacuum"};
inline constexpr Quantity kSide{"side", "", "side of the sheet that the light is on; front: adaxial, that of +z"};
inline constexpr Quantity kThetaI{"theta_i", "degree", "from the normal on the light's side to the light"};
inline constexpr Quantity kThetaO{"theta_o", "degree", "from the normal on the viewer's side to the viewer"};
inline constexpr Quantity kPhiO{"phi_o", "degree",
                                "from the light's azimuth to the viewer's; the mirror direction is at 180"};
inline constexpr Quantity kKind{"kind", "", "reflected: the viewer is on the light's side; transmitted: on the other"};
inline constexpr Quantity kReflectance{"R", "1", "directional-hemispherical reflectance"};
inline constexpr Quantity kTransmittance{"T", "1", "directional-hemispherical transmittance"};
inline constexpr Quantity kF{"f", "sr-1", "bidirectional reflectance or transmittance distribution function"};

}  // namespace frond
