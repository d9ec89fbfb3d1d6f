#pragma once

#include "core/log.h"
#include "core/messages/problems.h"
#include "scene/format/description.h"
#include "scene/format/unsupported.h"
#include "scene/registry.h"

namespace frond {

/// Replaces names of pbrt-v4 plug-ins by frond's. Replacements with the same expected image are logged (samplers;
/// integrators); others must be allowed by `unsupported` (scene/format/unsupported.h). Names of older
/// versions of pbrt are errors that explain how to upgrade a file.
void translate_pbrt_plugins(SceneDescription& description, const Registry& registry, const Unsupported& unsupported,
                            const Log& log, Problems& problems);

}  // namespace frond
