#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "exports/format.h"

namespace frond {

/// A material on a grid of directions, as tables of every format have it.
struct BsdfTable {
  std::vector<double> wavelengths_nm;
  static constexpr std::array<std::string_view, 2> kSides{"front", "back"};  ///< that the light is on
  std::vector<double> theta_i_deg;  ///< 0 to below 90, from that side's normal to the light
  std::vector<double> theta_o_deg;  ///< 0 to below 90, to the viewer from the normal on the viewer's side
  std::vector<double> phi_o_deg;    ///< from the light's azimuth to the viewer's
  static constexpr std::array<std::string_view, 2> kKinds{"reflected", "transmitted"};

  /// Shares of the light from theta_i, 0 to 1: over wavelength, side, theta_i.
  std::vector<double> reflectance, transmittance;
  /// 1/sr: over wavelength, side, theta_i, theta_o, phi_o and kind, which runs fastest.
  std::vector<float> f;
};

/// f at single directions; R and T integrated over all of them, to 1e-4 of their value. Throws InputError as
/// ExportedBsdf does, and without wavelengths. Without angles every 5 degrees from the normal, every 15 around it.
BsdfTable make_table(const ExportMaterial& material, const ExportRequest& request);

/// Throws InputError where a table is too large to be meant: for more than 2^28 numbers.
void check_table(const ExportRequest& request);

/// A list of words or numbers that says what a quantity is.
struct Quantity {
  std::string_view name, unit, doc;
};

/// In the order in which f runs over them; then R, T and f.
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
