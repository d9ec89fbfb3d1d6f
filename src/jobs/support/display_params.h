#pragma once

#include "image/display_image.h"
#include "jobs/record/common_params.h"

namespace frond {

inline constexpr JobParam kDisplayParam("display", ArgumentKind::text,
                                        "OpenColorIO display of PNG and JPEG output; sRGB by default.");
inline constexpr JobParam kViewParam("view", ArgumentKind::text, "View of the display.");

inline constexpr JobParam kExposureParam(
    "exposure", ArgumentKind::text,
    "Change of the exposure of PNG and JPEG output, a number from -64 to 64, or auto: a light meter, which makes the "
    "mean luminance mid grey (docs/color.md).",
    {.type = "STOPS", .unit = "stops"});

inline constexpr JobParam kWhiteParam("white-balance", ArgumentKind::text,
                                      "Light that PNG and JPEG output shows as white: a colour temperature from 1000 "
                                      "to 100000, of daylight or below 4000 "
                                      "of a blackbody, or auto: the scene's light (docs/color.md).",
                                      {.type = "KELVIN", .unit = "K"});

/// Parses --exposure. Throws InputError.
inline ExposureChoice exposure_choice(const Arguments& args) {
  const std::string text = args.text("exposure");
  const auto choice = parse_exposure(text);
  if (!choice)
    fail({}, "{}: a number from -64 to 64 (stops) or auto is needed; \"{}\" was given", args.spelled("exposure"), text);
  return *choice;
}

/// Returns the choice of --white-balance, if it is given. Throws InputError.
inline std::optional<WhiteChoice> white_choice(const Arguments& args) {
  if (!args.declares("white-balance") || !args.given("white-balance")) return {};
  const std::string text = args.text("white-balance");
  const auto choice = parse_white(text);
  if (!choice)
    fail({}, "{}: a number from 1000 to 100000 (K) or auto is needed; \"{}\" was given", args.spelled("white-balance"),
         text);
  return choice;
}

/// Returns the choice of --display, --view and, if they are given, --exposure and --white-balance. Throws InputError.
inline DisplayChoice display_choice(const Arguments& args) {
  DisplayChoice choice{args.text("display"), args.text("view"), {}, white_choice(args)};
  if (args.declares("exposure") && args.given("exposure")) choice.exposure = exposure_choice(args);
  return choice;
}

/// Reports an automatic exposure, or suggests one for an image that is nearly all black or mostly clipped. `applied`:
/// of the written image; empty for an EXR.
inline void report_exposure(const JobRun& run, bool is_auto, const std::optional<AppliedExposure>& applied,
                            const std::string& output) {
  if (!applied) return;
  if (is_auto) return run.log().info(fmt::format("{}: exposure {} stops", output, stops_text(applied->stops)));
  const std::string advice = exposure_advice(applied->meter, run.args.spelled("exposure"));
  if (!advice.empty()) run.log().info(fmt::format("{}: {}", output, advice));
}

}  // namespace frond
