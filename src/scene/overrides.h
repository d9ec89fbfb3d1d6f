#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/log.h"
#include "scene/format/description.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"

namespace frond {

/// Puts one material in place of another.
struct MaterialSwap {
  std::string from;  ///< name of a named material, or of a plugin; "*": every leaf
  PluginText to;
  Location where = {};  ///< of what asks for it
};

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

/// What the new material does not know of the old one's parameters is left out, with a warning: the two describe the
/// same leaf, but each has its own method. Throws InputError at `where`, which is then the place of what is new.
void swap_material(ParsedPlugin& plugin, const PluginText& to, const Registry& registry, const Log& log,
                   const Location& where = {});

/// In this order, each on what the last one left. Throws InputError where the scene has no such material.
void apply_swaps(SceneSettings& description, const std::vector<MaterialSwap>& swaps, const Registry& registry,
                 const Log& log);

}  // namespace frond
