#pragma once

#include <string>

namespace frond {

/// An OpenColorIO configuration with XYZ (D65) as its reference, every space of color_space.h, and displays sRGB and
/// SMPTE-C, each with views Standard and Raw.
std::string builtin_ocio_config();

}  // namespace frond
