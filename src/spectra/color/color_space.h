#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "spectra/matrix3.h"

namespace frond {

/// CIE 1931 xy.
struct Chromaticity {
  double x, y;
  /// XYZ of luminance 1.
  constexpr Triple xyz() const { return {x / y, 1, (1 - x - y) / y}; }
};

struct Chromaticities {
  Chromaticity red, green, blue, white;
};

/// White of D65 as the RGB standards round it.
inline constexpr Chromaticity kD65White{0.3127, 0.3290};

/// A space of three linear channels.
struct ColorSpace {
  std::string_view name;         ///< as a scene's ColorSpace directive has it
  std::string_view linear_name;  ///< in OpenColorIO's configuration, the film and image files
  Chromaticities chromaticities;
  /// To XYZ relative to a white of D65 and luminance 1, which is what the film measures; a space with another white is
  /// adapted (Bradford).
  Matrix3 xyz_from_rgb, rgb_from_xyz;
};

/// Name of CIE XYZ relative to D65, in OpenColorIO's configuration and for film channels.
inline constexpr std::string_view kXyzName = "XYZ";

std::span<const ColorSpace> color_spaces();

/// By either name. Throws InputError that lists what there is.
const ColorSpace& color_space(std::string_view name, const Location& where);

/// By either name, nullptr if there is none.
const ColorSpace* find_color_space(std::string_view name);

/// Names that scenes use.
std::vector<std::string_view> color_space_names();

/// What an image file says of its channels; those of XYZ itself for kXyzName, nullptr for unknown names.
const Chromaticities* chromaticities_of(std::string_view linear_name);

/// Matrix to XYZ such that RGB (1, 1, 1) is the space's own white at luminance 1 (SMPTE RP 177).
Matrix3 xyz_from_rgb(const Chromaticities& c);

/// Chromatic adaptation of XYZ by Bradford's cone responses (Lam 1985; constants from ICC.1:2010, annex E).
Matrix3 bradford(const Triple& from_white, const Triple& to_white);

}  // namespace frond
