#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/image.h"

namespace frond {

/// Exposure of an image for a display: a factor of 2^stops of its linear colours.
struct ExposureChoice {
  double stops = 0;
  bool is_auto = false;  ///< by metered_stops, of the image itself
  bool operator==(const ExposureChoice&) const = default;
};

/// Parses "auto" or a number of stops from -64 to 64. Returns nullopt for other text.
std::optional<ExposureChoice> parse_exposure(std::string_view text);

/// Result of a light meter for an image.
struct ExposureMeter {
  /// Change of exposure, in steps of a third of a stop, that makes the geometric mean of the luminance 0.18, mid grey,
  /// of all pixels that are not black; less, if more than 2 % of these would be above 1. 0 for a black image.
  double stops = 0;
  double dark = 0;  ///< share of the pixels with light whose luminance is below 0.002, which a display shows as black
  double clipped = 0;  ///< share of the pixels whose luminance is above 1
};

/// Exposure of an image that has been written for a display.
struct AppliedExposure {
  double stops = 0;     ///< change of exposure
  ExposureMeter meter;  ///< of the image with it
};

/// Measures the first three channels, which are linear in `space`.
ExposureMeter measure_exposure(const Image& image, std::string_view space);

/// Multiplies all values by 2^stops.
void expose(Image& image, double stops);

/// Returns a message for an image that is nearly all black or mostly clipped, which suggests `option` auto; "" for
/// others.
std::string exposure_advice(const ExposureMeter& meter, const std::string& option);

/// Returns stops as text: "+1.33", "-2", "0".
std::string stops_text(double stops);

}  // namespace frond
