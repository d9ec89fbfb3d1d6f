#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "spectra/matrix3.h"

namespace frond {

/// Chromaticity: CIE 1931 xy.
struct Chromaticity {
  double x, y;
  /// XYZ with this chromaticity and luminance Y = 1.
  constexpr Triple xyz() const { return {x / y, 1, (1 - x - y) / y}; }
};

/// Chromaticities of a space's primaries and of its white.
struct Chromaticities {
  Chromaticity red, green, blue, white;
};

/// Chromaticity of D65, rounded as in the RGB standards (IEC 61966-2-1, ITU-R BT.2020, ...).
inline constexpr Chromaticity kD65White{0.3127, 0.3290};

/// RGB colour space with linear channels.
struct ColorSpace {
  std::string_view name;         ///< in a scene's ColorSpace directive
  std::string_view linear_name;  ///< in OpenColorIO's configuration, the film and image files
  Chromaticities chromaticities;
  /// Conversion to and from the film's XYZ, in which D65 has luminance 1. A space with another white is adapted to D65
  /// (Bradford).
  Matrix3 xyz_from_rgb, rgb_from_xyz;
};

/// Name of CIE XYZ relative to D65, in the OpenColorIO configuration and for film channels.
inline constexpr std::string_view kXyzName = "XYZ";

/// All spaces: sRGB, SMPTE-C, Rec. 2020, P3-D65, ACES2065-1 and ACEScg.
std::span<const ColorSpace> color_spaces();

/// Returns the space with this name or linear name. Throws InputError at `where` if there is none, with a suggestion.
const ColorSpace& color_space(std::string_view name, const Location& where);

/// Returns the space with this name or linear name, nullptr if there is none.
const ColorSpace* find_color_space(std::string_view name);

/// Returns the names for a scene's ColorSpace directive.
std::vector<std::string_view> color_space_names();

/// Returns the chromaticities that an image file in this space stores in its header; for kXyzName the chromaticities of
/// XYZ itself. nullptr for an unknown name.
const Chromaticities* chromaticities_of(std::string_view linear_name);

/// Returns the matrix from RGB to XYZ that maps (1, 1, 1) to the space's own white at luminance 1 (SMPTE RP 177).
Matrix3 xyz_from_rgb(const Chromaticities& c);

/// Returns the chromatic adaptation of XYZ from one white to another by Bradford's cone responses (Lam 1985; constants
/// from ICC.1:2010, annex E).
Matrix3 bradford(const Triple& from_white, const Triple& to_white);

}  // namespace frond
