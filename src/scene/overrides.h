#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/log.h"
#include "scene/format/description.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond {

/// Replacement of a material.
struct MaterialSwap {
  std::string from;  ///< name of a named material, or of a material plug-in; "*": every leaf
  PluginText to;
  Location where = {};  ///< location of the request, for errors
};

/// The user's overrides of a scene file.
struct SceneOverrides {
  std::vector<MaterialSwap> swaps = {};
  std::string wavelengths = {};  ///< a PluginText; empty: the scene's
  /// A plug-in of the scene's type overrides only the given parameters; another one replaces it.
  std::optional<PluginText> integrator = {}, filter = {};
  bool separate_pixels = false;  ///< pixels share no samples: the filter's reconstruction becomes importance
  std::optional<uint64_t> seed = {};
  bool quick = false;  ///< half the resolution, a sixteenth of the samples
};

/// Writes the overrides into the description, so that it describes the complete render. `files` and `content_hash` are
/// unchanged. Throws InputError.
void apply_overrides(const SceneOverrides& overrides, SceneSettings& description, const Registry& registry,
                     const Log& log);

/// Replaces a material. Parameters that the new material does not have are dropped with a warning; the leaf's
/// parameters are kept. Throws InputError at `where`.
void swap_material(ParsedPlugin& plugin, const PluginText& to, const Registry& registry, const Log& log,
                   const Location& where = {});

/// Applies the swaps in order, each to the result of the previous one. Throws InputError if the scene has no such
/// material.
void apply_swaps(SceneSettings& description, const std::vector<MaterialSwap>& swaps, const Registry& registry,
                 const Log& log);

}  // namespace frond
