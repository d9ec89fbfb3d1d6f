#pragma once

#include <string>

namespace frond {

/// Returns the text of the built-in OpenColorIO configuration: its reference space is XYZ (D65); it contains all spaces
/// of color_space.h and the displays sRGB and SMPTE-C, each with the views Standard and Raw; sRGB also has ACES 1.0.
std::string builtin_ocio_config();

}  // namespace frond
