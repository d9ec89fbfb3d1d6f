#pragma once

#include "core/log.h"
#include "core/problems.h"
#include "scene/format/description.h"
#include "scene/format/unsupported.h"
#include "scene/registry.h"

namespace frond {

/// Replaces names of pbrt-v4 by plug-ins of another name. What gives the same image, but for noise, is reported
/// in the log (samplers; volpath, where there are no media); what does not has to be let pass
/// (scene/format/unsupported.h). Names of older versions of pbrt are errors that say how a file is upgraded.
void answer_pbrt_plugins(SceneDescription& description, const Registry& registry, const Unsupported& unsupported,
                         const Log& log, Problems& problems);

}  // namespace frond
