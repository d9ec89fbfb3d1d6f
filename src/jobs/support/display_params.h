#pragma once

#include "image/display_image.h"
#include "jobs/record/common_params.h"

namespace frond {

inline constexpr JobParam kDisplayParam("display", ArgumentKind::text,
                                        "OpenColorIO display of PNG and JPEG output; sRGB by default.");
inline constexpr JobParam kViewParam("view", ArgumentKind::text, "View of the display.");

/// Returns the choice of --display and --view.
inline DisplayChoice display_choice(const Arguments& args) { return {args.text("display"), args.text("view")}; }

}  // namespace frond
