#include "image/display_image.h"

#include <array>
#include <cmath>

#include "core/error.h"
#include "image/image_file.h"

namespace frond {

void check_display_choice(const std::string& path, const ColorManager& colors, const DisplayChoice& choice) {
  if (!is_exr(path)) return colors.check_names(choice.display, choice.view);
  if (!choice.display.empty() || !choice.view.empty())
    fail({}, "--display and --view are for .png and .jpg: {} holds linear values", path);
  if (choice.white) fail({}, "--white-balance is for .png and .jpg: {} holds the scene's radiance", path);
  if (choice.exposure)
    fail({}, "--exposure is for .png and .jpg: {} holds the scene's radiance; frond convert --exposure changes a copy",
         path);
}

namespace {

/// Balances the white of the image and adds the white to the header. An automatic balance of an image whose header does
/// not state its scene's light, because there is none, changes nothing.
void balance(Image& image, std::string_view space, const WhiteChoice& choice,
             std::map<std::string, std::string>& text) {
  const auto light = text.find(kLightWhiteKey);
  const auto of_scene = light == text.end() ? std::nullopt : parse_chromaticity(light->second);
  const auto white = choice.is_auto ? of_scene : daylight_white(choice.kelvin);
  if (!white) return;
  balance_white(image, space, *white);
  text["frond:white_balance"] = chromaticity_text(*white);
  if (const auto command = text.find("frond:command"); command != text.end())
    command->second += choice.is_auto ? " --white-balance auto" : fmt::format(" --white-balance {:.6g}", choice.kelvin);
}

/// Replaces values for which a display has no colour: NaN and minus infinity by black, infinity by what every view
/// shows white.
void make_finite(Image& image) {
  constexpr float kWhite = 1e6f;
  for (float& v : image.pixels)
    if (!std::isfinite(v)) v = v > 0 ? kWhite : 0;
}

}  // namespace

/// The stops of the header and of the command repeat an automatic exposure exactly.
AppliedExposure write_display_image(const std::string& path, const Image& image, std::string_view space,
                                    const ColorManager& colors, const DisplayChoice& choice,
                                    std::map<std::string, std::string> text) {
  Image shown = image.selected(std::array<size_t, 3>{0, 1, 2}, {"R", "G", "B"});
  make_finite(shown);
  if (choice.white) balance(shown, space, *choice.white, text);
  AppliedExposure applied{0, measure_exposure(shown, space)};
  if (choice.exposure) {
    applied.stops = choice.exposure->is_auto ? applied.meter.stops : choice.exposure->stops;
    text["frond:exposure"] = fmt::format("{:.6g}", applied.stops);
    if (const auto command = text.find("frond:command"); command != text.end())
      command->second += fmt::format(" --exposure={:.6g}", applied.stops);
    expose(shown, applied.stops);
    applied.meter = measure_exposure(shown, space);
  }
  colors.display(shown.pixels, space, choice.display, choice.view);
  write_image(path, shown, {.color_space = "", .text = text});
  return applied;
}

}  // namespace frond
