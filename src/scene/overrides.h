#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/log.h"
#include "scene/format/description.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"
#include "scene/swap.h"

namespace frond {

/// What a user says over a scene file.
struct SceneOverrides {
  std::vector<MaterialSwap> swaps = {};
  std::string wavelengths = {};  ///< a PluginText; empty: the scene's
  /// Of the scene's own kind: these parameters over the scene's. Of another: in its place.
  std::optional<PluginText> integrator = {}, filter = {};
  std::optional<uint64_t> seed = {};
  bool quick = false;  ///< half the resolution, a sixteenth of the samples
};

/// Writes the overrides into the description, which then says all that is to be rendered. What the scene's text is
/// (`files`, `content_hash`) stays. Throws InputError.
void apply_overrides(const SceneOverrides& overrides, SceneSettings& description, const Registry& registry,
                     const Log& log);

}  // namespace frond
