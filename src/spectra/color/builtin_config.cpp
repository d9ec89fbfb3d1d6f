#include "spectra/color/builtin_config.h"

#include <fmt/format.h>

#include "spectra/color/color_space.h"

namespace frond {
namespace {

// Transfer functions with the parameters of OpenColorIO's ExponentWithLinearTransform: IEC 61966-2-1, SMPTE ST 170.
constexpr std::string_view kSrgbCurve = "{gamma: 2.4, offset: 0.055, direction: inverse}";
constexpr std::string_view kSmpte170Curve = "{gamma: 2.2222222222222222, offset: 0.099, direction: inverse}";

std::string matrix(const Matrix3& m) {
  std::string text = "!<MatrixTransform> {matrix: [";
  for (const Triple& r : m.row) text += fmt::format("{:.17g}, {:.17g}, {:.17g}, 0, ", r[0], r[1], r[2]);
  return text + "0, 0, 0, 1]}";
}

std::string linear_space(const ColorSpace& s) {
  return fmt::format(
      "  - !<ColorSpace>\n    name: {}\n    family: linear\n    encoding: scene-linear\n    to_scene_reference: {}\n",
      s.linear_name, matrix(s.xyz_from_rgb));
}

std::string encoded_space(std::string_view name, const ColorSpace& s, std::string_view curve) {
  return fmt::format(
      "  - !<ColorSpace>\n    name: {}\n    family: display\n    encoding: sdr-video\n    from_scene_reference: "
      "!<GroupTransform>\n      children:\n        - {}\n        - !<ExponentWithLinearTransform> {}\n",
      name, matrix(s.rgb_from_xyz), curve);
}

// The view of the ACES configurations (OpenColorIO-Config-ACES), by the same name.
constexpr std::string_view kAcesView = "ACES 1.0 - SDR Video", kAcesSpace = "sRGB, ACES 1.0 SDR";

/// sRGB after ACES's output transform, which compresses highlights (reference and output rendering transform 1.0).
std::string aces_space() {
  return fmt::format(
      "  - !<ColorSpace>\n    name: \"{}\"\n    family: display\n    encoding: sdr-video\n    from_scene_reference: "
      "!<GroupTransform>\n      children:\n        - {}\n"
      "        - !<BuiltinTransform> {{style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0}}\n"
      "        - !<BuiltinTransform> {{style: DISPLAY - CIE-XYZ-D65_to_sRGB}}\n",
      kAcesSpace, matrix(color_space("aces2065-1", {}).rgb_from_xyz));
}

/// `views` are further views of the display.
std::string display(std::string_view name, std::string_view views = "") {
  return fmt::format(
      "  {0}:\n    - !<View> {{name: Standard, colorspace: {0}}}\n{1}    - !<View> {{name: Raw, colorspace: Raw}}\n",
      name, views);
}

}  // namespace

std::string builtin_ocio_config() {
  std::string text =
      "ocio_profile_version: 2\n"
      "roles:\n  aces_interchange: ACES2065-1\n  data: Raw\n  default: Raw\n  scene_linear: linear sRGB\n"
      "file_rules:\n  - !<Rule> {name: Default, colorspace: Raw}\n"
      "displays:\n";
  text += display("sRGB", fmt::format("    - !<View> {{name: {}, colorspace: \"{}\"}}\n", kAcesView, kAcesSpace));
  text += display("SMPTE-C");
  text += fmt::format("active_displays: [sRGB, SMPTE-C]\nactive_views: [Standard, {}, Raw]\ncolorspaces:\n", kAcesView);
  text += fmt::format("  - !<ColorSpace>\n    name: {}\n    family: linear\n    encoding: scene-linear\n", kXyzName);
  for (const ColorSpace& s : color_spaces()) text += linear_space(s);
  text += encoded_space("sRGB", color_space("srgb", {}), kSrgbCurve);
  text += encoded_space("SMPTE-C", color_space("smpte-c", {}), kSmpte170Curve);
  text += aces_space();
  text += "  - !<ColorSpace>\n    name: Raw\n    isdata: true\n";
  return text;
}

}  // namespace frond
