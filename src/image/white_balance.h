#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/image.h"
#include "spectra/color/color_space.h"

namespace frond {

/// Attribute of an image file with the chromaticity of its scene's light, "0.3127 0.329".
inline constexpr const char* kLightWhiteKey = "frond:light_white";

/// White balance of an image for a display: the light whose white is shown as neutral.
struct WhiteChoice {
  double kelvin = 0;     ///< colour temperature of daylight, or below 4000 K of a blackbody
  bool is_auto = false;  ///< the scene's light, kLightWhiteKey
  bool operator==(const WhiteChoice&) const = default;
};

/// Parses "auto" or a colour temperature from 1000 to 100000 K. Returns nullopt for other text.
std::optional<WhiteChoice> parse_white(std::string_view text);

/// Returns the chromaticity of daylight, or below 4000 K of a blackbody, as pbrt's "whitebalance" defines it.
Chromaticity daylight_white(double kelvin);

/// Chromaticities as the text of an attribute. `parse_chromaticity` returns nullopt for other text.
std::string chromaticity_text(const Chromaticity& c);
std::optional<Chromaticity> parse_chromaticity(std::string_view text);

/// Adapts the first three channels, which are linear in `space`, so that `white` becomes D65 (Bradford). Luminance of
/// that white is unchanged. Throws InputError for a space that frond does not know.
void balance_white(Image& image, std::string_view space, const Chromaticity& white);

}  // namespace frond
