#pragma once

#include "image/display_image.h"
#include "jobs/common_params.h"

namespace frond {

inline constexpr JobParam kDisplayParam{
    .name = "display", .kind = ArgumentKind::text, .doc = "Display of PNG and JPEG output; sRGB by default."};
inline constexpr JobParam kViewParam{.name = "view", .kind = ArgumentKind::text, .doc = "View of that display."};

inline DisplayChoice display_choice(const Arguments& args) { return {args.text("display"), args.text("view")}; }

}  // namespace frond
