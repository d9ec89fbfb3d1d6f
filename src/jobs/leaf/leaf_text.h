#pragma once

#include <string>

#include "core/log.h"
#include "core/params.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"

/// Leaves as text, such as `leaf_solved,specimen=maize`, without a scene.
namespace frond {

/// Returns the parameters of a leaf, checked against the declarations of `info`, which must outlive them. Throws
/// InputError, also for textures and references.
Params constant_params(const PluginInfo& info, const PluginText& leaf);

/// Describes a leaf such as `leaf_solved,N=1.5,Cab=40,Car=8,Cw=0.01,Cm=0.009`: the parameters of its walk, its contents
/// per area, and PROSPECT's numbers. A leaf given by those is that of the nearest walk, with the differences of R and
/// T. Throws InputError for a material that is no leaf, and for wrong parameters.
std::string describe_leaf(const std::string& text, const Registry& registry);

/// Logs by how much R and T of the walk differ from PROSPECT's, of a leaf that its numbers describe and a walk
/// replaces. Instruments prepare materials for each wavelength, where a message of the whole leaf has no place.
void log_walk_of_plates(const std::string& text, const Registry& registry, const Log& log);

}  // namespace frond
