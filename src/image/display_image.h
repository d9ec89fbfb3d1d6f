#pragma once

#include <map>
#include <string>

#include "core/image.h"
#include "image/exposure.h"
#include "image/white_balance.h"
#include "spectra/color/color_management.h"

namespace frond {

/// OpenColorIO display and view by which a PNG or JPEG is encoded; empty: the configuration's defaults. Exposure and
/// white balance, if they are chosen.
struct DisplayChoice {
  std::string display, view;
  std::optional<ExposureChoice> exposure = {};
  std::optional<WhiteChoice> white = {};
};

/// Throws InputError if the OpenColorIO configuration lacks the display or the view, or if one of these, an
/// exposure or a white balance is set for an EXR, whose values are linear.
void check_display_choice(const std::string& path, const ColorManager& colors, const DisplayChoice& choice);

/// Writes the first three channels of an image, which are linear in `space`, as PNG or JPEG encoded by a display
/// transform. `text` are header attributes by name; the exposure's attribute is added. Throws InputError.
AppliedExposure write_display_image(const std::string& path, const Image& image, std::string_view space,
                                    const ColorManager& colors, const DisplayChoice& choice,
                                    std::map<std::string, std::string> text);

}  // namespace frond
