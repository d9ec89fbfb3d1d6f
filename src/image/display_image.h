#pragma once

#include <map>
#include <string>

#include "core/image.h"
#include "spectra/color/color_management.h"

namespace frond {

/// Which OpenColorIO display and view a PNG or JPEG goes through; empty: the configuration's defaults.
struct DisplayChoice {
  std::string display, view;
};

/// Refuses names that OpenColorIO does not know, and any for an EXR, which holds linear values. Throws InputError.
void check_display_choice(const std::string& path, const ColorManager& colors, const DisplayChoice& choice);

/// R, G and B of an image that is linear in `space`, through a display transform, as PNG or JPEG.
void write_display_image(const std::string& path, const Image& image, std::string_view space,
                         const ColorManager& colors, const DisplayChoice& choice,
                         const std::map<std::string, std::string>& text);

}  // namespace frond
