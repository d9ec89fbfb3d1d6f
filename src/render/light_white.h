#pragma once

#include <optional>

#include "core/world.h"
#include "spectra/color/color_space.h"

namespace frond {

/// Returns the chromaticity of the light of a scene: the sum of its lights' spectra, weighted by their photometric
/// power. Empty if there is no light that can be seen.
std::optional<Chromaticity> light_white(const World& world);

}  // namespace frond
