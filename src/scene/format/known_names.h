#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/format/description.h"

namespace frond {

/// Returns the end of an error message about a name that the scene does not define: as `suggestion`, but if the scene
/// has read foreign files (core/messages/excerpt.h), which may define names, with the first characters of each.
std::string suggested_name(const SceneSettings& scene, std::string_view name,
                           const std::vector<std::string_view>& defined);

}  // namespace frond
