#pragma once

#include <string>
#include <vector>

#include "core/params.h"
#include "core/plugin.h"

namespace frond {

/// A leaf on a command line, `specimen=maize thickness=1e-4`, as parameters of `info`, a leaf material or what all of
/// them take. Throws InputError for what is no number or word that these take: textures have no place there.
Params leaf_from_words(const PluginInfo& info, const std::vector<std::string>& words);

}  // namespace frond
